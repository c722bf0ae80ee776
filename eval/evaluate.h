#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "eval/metrics/metrics.h"
#include "eval/run_folder.h"

namespace saccade {

struct EvaluateOptions {
  /// Scored against this dataset instead of the one in run.yaml.
  std::optional<std::filesystem::path> dataset;
  /// d of dt_rel instead of the dataset's mean scene depth [m], > 0.
  std::optional<double> mean_depth_m;
  /// A run of `refine` over the same dataset: the run's errors are divided by its errors.
  std::optional<std::filesystem::path> refined;
};

/// Scores a run folder against the ground truth of its dataset and writes RUN/metrics.json
/// (docs/metrics.md), of depth also RUN/depth_views.csv with the scores of every view. What cannot
/// be measured is null: a dataset without ground truth still gives the speed. Throws InputError for
/// a folder that is no run, a missing dataset, malformed files.
Metrics evaluate_run(const std::filesystem::path& run_folder, const EvaluateOptions& options = {});

/// The same without reading and writing folders; `mean_depth_m` is d of dt_rel, nullopt: unknown.
[[nodiscard]] Metrics score_run(const RunFolder& run, const Dataset& dataset,
                                const std::optional<double>& mean_depth_m);

/// Scores a trajectory of any program (TUM text) against a dataset's whole ground truth. Writes the
/// scores to `output` where one is given.
Metrics evaluate_trajectory(const std::filesystem::path& estimate_file,
                            const std::filesystem::path& dataset_folder,
                            const std::optional<std::filesystem::path>& output = std::nullopt,
                            const std::optional<double>& mean_depth_m = std::nullopt);

/// The same of a trajectory in memory.
[[nodiscard]] Metrics score_estimate(const Trajectory& estimate, const Dataset& dataset,
                                     const std::optional<double>& mean_depth_m = std::nullopt);

/// Depth that an external program estimated.
struct ExternalDepth {
  /// A point cloud in the world (PLY), a depth map (EXR), or a folder with depth maps that
  /// views.yaml lists.
  std::filesystem::path file;
  bool is_cloud = false;
  /// Time of the view, not of a folder; default: of the dataset's first depth map.
  std::optional<double> at_s;
};

/// Scores it as evaluate_run() scores a run of `depth`.
Metrics evaluate_depth(const ExternalDepth& depth, const std::filesystem::path& dataset_folder,
                       const std::optional<std::filesystem::path>& output = std::nullopt);

/// Scores an image of any program (EXR of log intensity, or a picture; undistorted) at `at_s`, or a
/// folder with images that views.yaml lists, as evaluate_run() scores a run of `reconstruct`.
Metrics evaluate_image(const std::filesystem::path& file, const std::optional<double>& at_s,
                       const std::filesystem::path& dataset_folder,
                       const std::optional<std::filesystem::path>& output = std::nullopt);

/// The scores as a table for a terminal, below a line with `title`; a dash where a score is null.
[[nodiscard]] std::string format_metrics(const Metrics& metrics, const std::string& title);

/// A number of timing.json: the plain value at `key`, or its median where it was repeated.
[[nodiscard]] std::optional<double> speed_value(const Metrics& metrics, const std::string& key);

}  // namespace saccade
