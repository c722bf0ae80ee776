#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config/fields.h"

namespace saccade {

/// The contents of dataset.yaml. Only `format_version`, `width` and `height` must be stated; a
/// person may write such a file beside a recording to state its facts.
struct DatasetRecord {
  struct Counts {
    std::int64_t events_on = 0;
    std::int64_t events_off = 0;
    std::int64_t frames = 0;
    std::int64_t depth_maps = 0;
    std::int64_t flow_maps = 0;
    std::int64_t imu_samples = 0;
    std::int64_t masks = 0;
    std::int64_t normal_maps = 0;
    std::int64_t optical_flows = 0;  ///< pairs of fields, forward and backward
  };

  /// A measured figure with its 95 % confidence interval.
  struct Figure {
    double value = 0;
    double low = 0;
    double high = 0;
  };
  /// How events that were sampled agree with the reference's of some pixels, one-to-one per pixel and
  /// polarity within 1 or 10 us.
  struct Audit {
    std::string reference = "exact";  ///< or dense: sampled as well, many times finer
    std::int64_t pixels = 0;
    std::int64_t events = 0;  ///< of the reference
    Figure precision_10us, recall_10us;
    Figure precision_1us, recall_1us;
    Figure p99_dt_us;
  };

  int format_version = 1;
  std::string name;          ///< of the scene
  std::string tool_version;  ///< empty: not written by this program
  int width = 0;             ///< [px]
  int height = 0;            ///< [px]
  std::uint64_t seed = 0;
  std::string config_yaml;  ///< the resolved configuration, as text; empty when unknown
  std::string timestamp_unit = "us";
  double duration_s = 0;
  std::optional<Counts> counts;
  std::optional<double> mean_scene_depth_m;  ///< mean valid z over all depth maps
  std::optional<double> contrast_on;         ///< [log units]
  std::optional<double> contrast_off;
  double log_eps = 1e-3;
  std::optional<std::int64_t> rays;
  std::optional<double> rays_per_event;
  std::optional<std::int64_t> lit_points;       ///< whose light was found
  std::optional<std::int64_t> surface_samples;  ///< of known triangles, without a ray
  std::optional<std::int64_t> lost_events;      ///< met a full readout
  std::optional<double> time_bound_us;  ///< of every event's time, before rounding to the unit
  std::optional<double> path_length_m;  ///< of the camera
  std::optional<std::string> sampling;  ///< of the events: exact, adaptive or frames
  std::optional<std::string> sampling_reason;  ///< where it was chosen automatically
  std::optional<Audit> audit;                  ///< of events that were sampled adaptively
  std::map<std::string, std::string> sha256;   ///< of every file but dataset.yaml, by relative path
};

void describe(config::Fields& fields, DatasetRecord& record);

/// InputError with file:line; another format_version than 1 is an error.
[[nodiscard]] DatasetRecord read_dataset_record(const std::filesystem::path& file);
void write_dataset_record(const std::filesystem::path& file, const DatasetRecord& record);

/// SHA-256 of every file below `folder` but dataset.yaml, by path relative to it; in parallel.
[[nodiscard]] std::map<std::string, std::string> hash_files(const std::filesystem::path& folder);

/// Compares a dataset with the hashes in its dataset.yaml: one line per file that is missing,
/// changed or not listed; empty when all agree. InputError when the file states no hashes.
[[nodiscard]] std::vector<std::string> verify_hashes(const std::filesystem::path& folder);

}  // namespace saccade
