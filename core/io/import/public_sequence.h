#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/calibration_file.h"
#include "core/trajectory.h"
#include "core/trigger.h"

namespace saccade {

/// A recording as its publisher or the camera's program lays it out, for conversion into a dataset
/// (docs/public_datasets.md). Times are those of its own clock [s].
struct PublicSequence {
  std::string layout;                    ///< "DSEC", "TUM-VIE", "AEDAT4"
  std::filesystem::path events;          ///< of one camera, or FILE!/member; empty: none
  ChainCamera camera;                    ///< that one
  std::vector<StampedPose> groundtruth;  ///< world_from_camera; empty: none
  std::vector<ImuSample> imu;            ///< empty: none
  std::vector<Trigger> triggers;
  std::vector<double> frame_times_s;  ///< increasing; of what load_frame() reads
  std::function<ImageU8(std::size_t)> load_frame;
  std::vector<double> depth_times_s;  ///< likewise
  /// z depth [m] at the sensor's pixels, 0 = unknown.
  std::function<ImageF(std::size_t)> load_depth;
};

/// nullopt where `path` is a folder or a file of none of the layouts below; InputError where it has
/// one, and something is missing or malformed. `calibration`: read in place of the layout's own
/// (camera_files.h); empty: none.
[[nodiscard]] std::optional<PublicSequence> open_public_sequence(
    const std::filesystem::path& path, const std::filesystem::path& calibration = {});

/// A part of a sequence, in seconds from its first event, or its first frame where it has no events.
struct ImportWindow {
  double start_s = 0;
  std::optional<double> duration_s;
};

/// What became a dataset.
struct ImportCounts {
  std::uint64_t events = 0;
  std::uint64_t frames = 0;
  std::uint64_t depth_maps = 0;
  std::uint64_t imu_samples = 0;
  std::uint64_t poses = 0;
  std::uint64_t triggers = 0;

  /// "5 events, 2 frames and 3 poses"; what is 0 is left out, but for the events.
  [[nodiscard]] std::string text() const;
};

/// Writes it as a dataset folder, block by block. Without a start, what comes before the first event
/// is written as well.
ImportCounts write_as_dataset(const PublicSequence& sequence, const std::filesystem::path& folder,
                              const ImportWindow& window = {});

}  // namespace saccade
