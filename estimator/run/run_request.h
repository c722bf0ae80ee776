#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/config/document.h"

namespace saccade {

/// What `saccade run MODULE` was asked to do, whatever the module.
struct RunRequest {
  std::filesystem::path dataset;
  std::filesystem::path output;  ///< run folder; appears under this name only when complete
  config::Document config = config::Document::empty();
  std::optional<double> start_s;     ///< from the dataset's time zero; default: its first event
  std::optional<double> duration_s;  ///< default: to its last event
  /// A run folder or a trajectory file whose poses stand in for the ground truth's; of modules that
  /// take poses.
  std::optional<std::filesystem::path> poses_from;
  /// Spacing of the knots of a spline by which the poses are smoothed; of modules that take poses.
  std::optional<double> smooth_poses_s;
  /// A run folder whose depth stands in for the dataset's; of modules that take depth.
  std::optional<std::filesystem::path> depth_from;
  /// A run folder that is refined; of modules that take a run.
  std::optional<std::filesystem::path> from;
  std::optional<std::uint64_t> seed;  ///< in place of the configuration's
  int threads = 1;                    ///< as stated in run.yaml
  int repeat = 1;                     ///< how often the work is done, for timing; >= 1
  std::string command;                ///< command line, for run.yaml
};

/// What there is to say on one line after a run.
struct RunSummary {
  std::string found;       ///< "812 poses (0 lost)"
  std::size_t events = 0;  ///< given to the estimator
  std::size_t poses = 0;   ///< found, of modules that find poses
  std::size_t lost_poses = 0;
  /// Since when all poses are lost; nullopt where the last one is not.
  std::optional<double> lost_since_s = {};
  double wall_s = 0;  ///< median over the repetitions, without reading and writing
};

}  // namespace saccade
