#include "eval/evaluate.h"

#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/io/covariance_file.h"
#include "core/io/files/atomic_file.h"
#include "core/io/imu_file.h"
#include "core/io/run/keyframe_list.h"
#include "core/io/trajectory_file.h"
#include "eval/depth_views.h"
#include "eval/image_views.h"
#include "eval/metrics/catalogue.h"
#include "eval/metrics/orientation_metrics.h"
#include "eval/metrics/sharpness.h"
#include "eval/metrics/trajectory/consistency.h"
#include "eval/metrics/trajectory/keyframe_metrics.h"
#include "eval/metrics/trajectory/loss_metrics.h"
#include "eval/metrics/trajectory/reprojection.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/mosaic_view.h"
#include "eval/refined_ratio.h"
#include "eval/score_inputs.h"

namespace saccade {
namespace {

void check_depth(const std::optional<double>& mean_depth_m) {
  if (mean_depth_m && !(*mean_depth_m > 0)) throw InputError("mean depth", "must be above 0 m");
}

void merge(Metrics& metrics, const Metrics& more, const std::string& prefix) {
  for (const auto& [key, value] : more.values()) metrics.set(prefix + key, value);
}

/// What a trajectory alone tells.
void score_path(const TrajectoryScoreInput& input, Metrics& metrics) {
  merge(metrics, score_trajectory(input), "");
  merge(metrics, score_loss(input), "");
  metrics.set("success", success_of(metrics));
}

/// The orientations that `run` estimated, and the events that it stabilized.
void score_rotation(const RunFolder& run, const Dataset& dataset, Metrics& metrics) {
  const std::filesystem::path orientation = run.folder / "orientation.txt";
  const std::filesystem::path biases = run.folder / "gyro_bias.txt";
  if (std::filesystem::exists(orientation)) {
    OrientationScoreInput input;
    input.estimate = read_orientations(orientation);
    input.truth = dataset.groundtruth();
    if (std::filesystem::exists(biases)) input.biases = read_gyro_biases(biases);
    if (std::filesystem::exists(dataset.folder() / "imu_groundtruth.txt"))
      input.imu_truth = dataset.load_imu_truth();
    merge(metrics, score_orientation(input), "");
  }
  const std::filesystem::path rates = run.folder / "angular_velocity.txt";
  if (std::filesystem::exists(rates)) {
    if (std::filesystem::exists(dataset.folder() / "twist.txt"))
      merge(metrics, score_rates(read_angular_velocities(rates), dataset.load_twists()), "");
    else if (dataset.has_imu())
      merge(metrics,
            score_rates_by_gyroscope(read_angular_velocities(rates), dataset.load_imu(),
                                     dataset.camera_from_imu().value_or(Rigid3())),
            "");
  }
  if (std::filesystem::exists(run.folder / "stabilized" / "windows.csv"))
    merge(metrics, score_stabilization(load_stabilized(run.folder / "stabilized"), dataset), "");
}

Metrics score(const RunFolder& run, const Dataset& dataset,
              const std::vector<EstimatedView>& depths,
              const std::vector<DepthErrors>& depth_errors,
              const std::optional<double>& mean_depth_m) {
  Metrics metrics;
  merge(metrics, run.timing, "speed.");
  if (!depths.empty()) merge(metrics, score_depth(depths, depth_errors, dataset.camera()), "");
  if (const auto images = load_image_views(run.folder); !images.empty())
    merge(metrics, score_images(images, dataset), "");
  score_rotation(run, dataset, metrics);
  if (const auto mosaic = load_mosaic(run))
    merge(metrics, score_mosaic(compare_mosaic(*mosaic, run, dataset)), "");
  if (!run.trajectory) return metrics;
  TrajectoryScoreInput input = score_input(run, dataset);
  input.mean_depth_m = mean_depth_m;
  score_path(input, metrics);
  metrics.set("trajectory.nees", nees(run.load_covariances(), input));
  if (const auto keyframes = run.folder / "keyframes.yaml"; std::filesystem::exists(keyframes))
    merge(metrics, score_keyframes(read_keyframe_list(keyframes), input), "");
  set_reprojection(metrics, reproject(truth_from_estimate(input) * run.load_map().positions,
                                      scored_samples(input), dataset.camera().undistorted()));
  return metrics;
}

/// The refined run over the time that `run` is scored over.
Metrics score_refined(const std::filesystem::path& folder, const RunFolder& run,
                      const Dataset& dataset, const std::optional<double>& mean_depth_m) {
  RunFolder refined = RunFolder::open(folder);
  if (refined.record.module != "refine")
    throw InputError(folder.string(),
                     "is a run of " + refined.record.module + ", not of refine (--refined)");
  if (refined.record.dataset_sha256 != run.record.dataset_sha256)
    throw InputError(folder.string(), "is a run over another dataset (--refined)");
  refined.record.window = run.record.window;
  return score_run(refined, dataset, mean_depth_m);
}

}  // namespace

Metrics score_run(const RunFolder& run, const Dataset& dataset,
                  const std::optional<double>& mean_depth_m) {
  const std::vector<EstimatedView> depths = load_depth_views(run, dataset, mean_depth_m);
  return score(run, dataset, depths, compare_views(depths, dataset), mean_depth_m);
}

Metrics evaluate_run(const std::filesystem::path& run_folder, const EvaluateOptions& options) {
  check_depth(options.mean_depth_m);
  const RunFolder run = RunFolder::open(run_folder);
  const Dataset dataset = run.open_dataset(options.dataset);
  const std::optional<double> mean_depth_m =
      options.mean_depth_m ? options.mean_depth_m : dataset.facts().mean_depth_m;
  const std::vector<EstimatedView> depths = load_depth_views(run, dataset, mean_depth_m);
  const std::vector<DepthErrors> depth_errors = compare_views(depths, dataset);
  Metrics metrics = score(run, dataset, depths, depth_errors, mean_depth_m);
  if (options.refined)
    merge(metrics,
          refined_ratios(metrics, score_refined(*options.refined, run, dataset, mean_depth_m)), "");
  metrics = catalogued(std::move(metrics));
  write_atomically(run_folder / "metrics.json",
                   to_json(metrics, score_inputs(run_folder, dataset)));
  if (!depths.empty()) write_depth_views_csv(run_folder / "depth_views.csv", depth_errors);
  return metrics;
}

Metrics evaluate_trajectory(const std::filesystem::path& estimate_file,
                            const std::filesystem::path& dataset_folder,
                            const std::optional<std::filesystem::path>& output,
                            const std::optional<double>& mean_depth_m) {
  Metrics metrics =
      score_estimate(read_estimate(estimate_file), Dataset::open(dataset_folder), mean_depth_m);
  if (output) write_atomically(*output, to_json(metrics));
  return metrics;
}

Metrics score_estimate(const Trajectory& estimate, const Dataset& dataset,
                       const std::optional<double>& mean_depth_m) {
  check_depth(mean_depth_m);
  TrajectoryScoreInput input;
  input.estimate = estimate;
  input.truth = dataset.groundtruth();
  input.mean_depth_m = mean_depth_m ? mean_depth_m : dataset.facts().mean_depth_m;
  Metrics metrics;
  score_path(input, metrics);
  return catalogued(std::move(metrics));
}

Metrics evaluate_depth(const ExternalDepth& depth, const std::filesystem::path& dataset_folder,
                       const std::optional<std::filesystem::path>& output) {
  const Dataset dataset = Dataset::open(dataset_folder);
  std::vector<EstimatedView> views;
  if (std::filesystem::is_directory(depth.file)) {
    views = load_depth_views(depth.file);
    if (views.empty()) throw InputError(depth.file.string(), "holds no views.yaml with depth maps");
  } else {
    if (!depth.at_s && dataset.depth_maps().empty())
      throw InputError("--at-s", "state the time of the view: the dataset has no depth maps");
    const double t_s = depth.at_s ? *depth.at_s : dataset.depth_maps().front().t_s;
    views = {depth.is_cloud ? load_cloud(depth.file, dataset, t_s)
                            : load_depth_map(depth.file, dataset, t_s)};
  }
  Metrics metrics = catalogued(score_depth(views, compare_views(views, dataset), dataset.camera()));
  if (output) write_atomically(*output, to_json(metrics));
  return metrics;
}

Metrics evaluate_image(const std::filesystem::path& file, const std::optional<double>& at_s,
                       const std::filesystem::path& dataset_folder,
                       const std::optional<std::filesystem::path>& output) {
  const Dataset dataset = Dataset::open(dataset_folder);
  std::vector<ImageView> views;
  if (std::filesystem::is_directory(file)) {
    views = load_image_views(file);
    if (views.empty()) throw InputError(file.string(), "holds no views.yaml with images");
  } else {
    if (!at_s) throw InputError("--at-s", "state the time of the view of --image");
    views = {load_image(file, dataset, *at_s)};
  }
  Metrics metrics = catalogued(score_images(views, dataset));
  if (output) write_atomically(*output, to_json(metrics));
  return metrics;
}

}  // namespace saccade
