#include "eval/evaluate.h"

#include "core/error.h"
#include "core/io/atomic_file.h"
#include "eval/metrics/reprojection.h"
#include "eval/metrics/trajectory_metrics.h"

namespace saccade {
namespace {

void check_depth(const std::optional<double>& mean_depth_m) {
  if (mean_depth_m && !(*mean_depth_m > 0)) throw InputError("mean depth", "must be above 0 m");
}

void merge(Metrics& metrics, const Metrics& more, const std::string& prefix) {
  for (const auto& [key, value] : more.values()) metrics.set(prefix + key, value);
}

}  // namespace

Metrics score_run(const RunFolder& run, const Dataset& dataset,
                  const std::optional<double>& mean_depth_m) {
  Metrics metrics;
  merge(metrics, run.timing, "speed.");
  if (!run.trajectory) return metrics;
  TrajectoryScoreInput input = score_input(run, dataset);
  input.mean_depth_m = mean_depth_m;
  merge(metrics, score_trajectory(input), "");
  set_reprojection(metrics, reproject(run.load_map().positions, scored_samples(input),
                                      dataset.camera().undistorted()));
  return metrics;
}

Metrics evaluate_run(const std::filesystem::path& run_folder, const EvaluateOptions& options) {
  check_depth(options.mean_depth_m);
  const RunFolder run = RunFolder::open(run_folder);
  const Dataset dataset = run.open_dataset(options.dataset);
  const Metrics metrics = score_run(
      run, dataset, options.mean_depth_m ? options.mean_depth_m : dataset.facts().mean_depth_m);
  write_atomically(run_folder / "metrics.json", to_json(metrics));
  return metrics;
}

Metrics evaluate_trajectory(const std::filesystem::path& estimate_file,
                            const std::filesystem::path& dataset_folder,
                            const std::optional<std::filesystem::path>& output,
                            const std::optional<double>& mean_depth_m) {
  check_depth(mean_depth_m);
  const Dataset dataset = Dataset::open(dataset_folder);
  TrajectoryScoreInput input;
  input.estimate = read_estimate(estimate_file);
  input.truth = dataset.groundtruth();
  input.mean_depth_m = mean_depth_m ? mean_depth_m : dataset.facts().mean_depth_m;
  const Metrics metrics = score_trajectory(input);
  if (output) write_atomically(*output, to_json(metrics));
  return metrics;
}

}  // namespace saccade
