#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/covariance_file.h"
#include "core/io/dataset/dataset.h"
#include "core/io/ply_file.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// One row of poses.csv. Numbers that the file does not state are NaN.
struct PoseRow {
  double t_s = 0;
  double first_event_s = 0;
  double last_event_s = 0;
  std::string status;  ///< ok, lost or relocalised
  double inlier_ratio = 0;
  double iterations = 0;
  double residual = 0;
  double probability = 0;  ///< that the pose is right
};

/// run.yaml of a run folder. Throws InputError where there is none, and says what stands there instead.
[[nodiscard]] std::filesystem::path run_record_of(const std::filesystem::path& folder);

/// A run folder, by whatever estimator. Opening reads run.yaml and, where they exist,
/// trajectory.txt, poses.csv, timing.json and metrics.json.
struct RunFolder {
  std::filesystem::path folder;
  RunRecord record;
  std::optional<Trajectory> trajectory;  ///< empty where no pose was written
  std::optional<std::vector<PoseRow>> poses;
  Metrics timing;
  Metrics metrics;

  /// Throws InputError where the folder holds no run.yaml or something malformed.
  [[nodiscard]] static RunFolder open(const std::filesystem::path& folder);

  /// Last part of the folder's path.
  [[nodiscard]] std::string name() const;
  /// Points of map.ply; empty where there is none.
  [[nodiscard]] PointCloud load_map() const;
  /// What of its world no input told: nothing, unless it found its start by itself (start.yaml), and
  /// less where an inertial sensor then brought it into metres and upright (inertial.yaml).
  [[nodiscard]] Alignment freedom() const;
  /// Of covariance.txt; none where there is none.
  [[nodiscard]] std::vector<StampedCovariance> load_covariances() const;
  /// The dataset it ran on, or the one at `instead`.
  [[nodiscard]] Dataset open_dataset(
      const std::optional<std::filesystem::path>& instead = std::nullopt) const;
};

/// TUM file, or an empty trajectory where the file holds no line at all: an estimator that never
/// found a pose writes such a file.
[[nodiscard]] Trajectory read_estimate(const std::filesystem::path& file);

/// What of a run and its dataset goes into the trajectory scores. The window is the run's; without
/// one in run.yaml the whole ground truth is scored.
[[nodiscard]] TrajectoryScoreInput score_input(const RunFolder& run, const Dataset& dataset);

}  // namespace saccade
