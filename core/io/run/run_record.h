#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/config/fields.h"
#include "core/io/run/method_class.h"

namespace saccade {

/// The contents of run.yaml: where a run folder comes from. Only `format_version`, `module` and
/// `dataset.path` must be stated.
struct RunRecord {
  /// The part of the dataset the estimator was given, in seconds from the dataset's time zero.
  struct Window {
    double start_s = 0;
    double end_s = 0;
  };

  /// A program of somebody else that `saccade run external` ran.
  struct External {
    std::string name;     ///< of the method
    std::string version;  ///< as the program states it; empty: not asked for
    /// "ok", "crashed", "timed out" or "bad output"; without "ok" the run holds no poses.
    std::string status = "ok";
    std::string reason;  ///< what went wrong
  };

  /// Contrast thresholds that the module found, because nobody stated them [log units].
  struct Contrast {
    double on = 0, off = 0;
  };

  int format_version = 1;
  std::string module;                ///< "track", "depth", ...
  std::filesystem::path dataset;     ///< folder; in the file relative to run.yaml, or absolute
  std::string dataset_sha256;        ///< of its dataset.yaml, or of its events where it has none
  std::filesystem::path poses_from;  ///< run or trajectory file; empty: not in place of the truth's
  std::optional<double>
      smooth_poses_s;  ///< spacing of the knots of a spline by which they were smoothed
  std::filesystem::path depth_from;         ///< depth run; empty: not in place of the dataset's
  std::filesystem::path from;               ///< run that was refined; empty: none
  std::optional<External> external;         ///< nullopt: one of this program's modules
  std::optional<MethodClass> method_class;  ///< what it was given in all; nullopt: not known
  std::optional<Contrast> contrast;         ///< nullopt: stated, or not needed
  std::optional<Window> window;             ///< nullopt: the whole dataset
  std::uint64_t seed = 0;
  int threads = 0;           ///< 0: not stated
  std::string tool_version;  ///< "0.1.0 (1234567890ab)"
  std::string command;       ///< command line; empty when the library was called
  std::string machine;       ///< processor and operating system
  std::string config_yaml;   ///< the resolved configuration, as text

  /// What is to be said of a run that came to nothing, "timed out: ..."; empty where all is well.
  [[nodiscard]] std::string problem() const;
  /// Of tool_version what stands before the brackets and in them: "0.1.0" and "1234567890ab", which
  /// is empty where there are none.
  [[nodiscard]] std::string version() const;
  [[nodiscard]] std::string commit() const;
};

void describe(config::Fields& fields, RunRecord& record);

/// InputError with file:line; another format_version than 1 is an error.
[[nodiscard]] RunRecord read_run_record(const std::filesystem::path& file);
void write_run_record(const std::filesystem::path& file, const RunRecord& record);

}  // namespace saccade
