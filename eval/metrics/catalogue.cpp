#include "eval/metrics/catalogue.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/check.h"

namespace saccade {
namespace {

constexpr auto kNeither = MetricInfo::Better::kNeither;
constexpr auto kHigher = MetricInfo::Better::kHigher;

constexpr const char* kTruePath = "trajectory, ground truth";
constexpr const char* kTruePathAndDepth = "trajectory, ground truth, mean scene depth";
constexpr const char* kReport = "trajectory, ground truth, mean scene depth, poses.csv";
constexpr const char* kTrueDepth = "depth maps, true depth";
constexpr const char* kTrueFrames = "images, true frames";
constexpr const char* kTruePanorama = "mosaic, true panorama";
constexpr const char* kTwoStreams = "two streams of events";
constexpr const char* kTiming = "timing.json";
constexpr const char* kDataset = "dataset.yaml";

/// The tables that follow are the catalogue, by part of metrics.json. A row states what differs
/// from "a number without a unit of which less is better".
// clang-format off
std::vector<MetricInfo> trajectory_rows() {
  return {
      {.key = "trajectory.dt_rel_percent.mean", .label = "dt_rel [%]", .unit = "%",
       .needs = kTruePathAndDepth, .floor = 0.001, .board = "dt_rel, mean", .in_tables = true,
       .in_figures = true},
      {.key = "trajectory.dt_rel_percent.*", .unit = "%", .needs = kTruePathAndDepth},
      {.key = "trajectory.dtheta_deg.mean", .label = "dtheta [deg]", .unit = "deg",
       .needs = kTruePath, .floor = 0.001, .board = "dtheta, mean", .in_tables = true,
       .in_figures = true},
      {.key = "trajectory.dtheta_deg.*", .unit = "deg", .needs = kTruePath},
      {.key = "trajectory.dt_m.*", .unit = "m", .scale = 1000, .needs = kTruePath},
      {.key = "trajectory.none.ate_rmse_m", .unit = "m", .scale = 1000, .needs = kTruePath,
       .floor = 1e-5},
      {.key = "trajectory.yaw.ate_rmse_m", .unit = "m", .scale = 1000, .needs = kTruePath},
      {.key = "trajectory.se3.ate_rmse_m", .unit = "m", .scale = 1000, .needs = kTruePath,
       .board = "ATE after SE(3), RMSE"},
      {.key = "trajectory.sim3.ate_rmse_m", .unit = "m", .scale = 1000, .needs = kTruePath,
       .board = "ATE after Sim(3), RMSE"},
      {.key = "trajectory.*.rot_rmse_deg", .unit = "deg", .needs = kTruePath},
      {.key = "trajectory.*.scale", .better = kNeither, .needs = kTruePath},
      {.key = "trajectory.se3_5s.mean_percent", .unit = "%", .needs = kTruePath,
       .board = "error after SE(3) by the first 5 s, mean, of the path"},
      {.key = "trajectory.nees", .better = kNeither,
       .needs = "trajectory, ground truth, covariances",
       .board = "poses' covariances, factor between NEES and 6"},
      {.key = "trajectory.reprojection_px.rms", .unit = "px",
       .needs = "trajectory, ground truth, map", .floor = 0.001},
      {.key = "trajectory.reprojection_px.*", .unit = "px",
       .needs = "trajectory, ground truth, map"},
      {.key = "trajectory.coverage", .scale = 100, .better = kHigher, .needs = kTruePath,
       .floor = 0.01, .tolerance = 0.005},
      {.key = "trajectory.lost_s", .label = "lost [s]", .unit = "s", .needs = kTruePathAndDepth,
       .floor = 0.1, .in_tables = true},
      {.key = "trajectory.reported_lost_s", .unit = "s", .needs = "trajectory, poses.csv"},
      {.key = "trajectory.loss.precision", .label = "loss precision", .scale = 100,
       .better = kHigher, .needs = kReport},
      {.key = "trajectory.loss.recall", .label = "loss recall", .scale = 100, .better = kHigher,
       .needs = kReport},
      {.key = "trajectory.loss.delay_ms", .label = "loss delay [ms]", .unit = "ms",
       .needs = kReport},
      {.key = "trajectory.loss.unreported_s", .label = "unreported [s]", .unit = "s",
       .needs = kReport, .in_tables = true},
      {.key = "trajectory.loss.reported_s", .unit = "s", .better = kNeither, .needs = kReport},
      {.key = "trajectory.loss.count", .needs = kReport},
      {.key = "trajectory.loss.first_s", .unit = "s", .better = kHigher,
       .needs = kTruePathAndDepth},
      {.key = "success", .label = "success", .scale = 100, .better = kHigher,
       .needs = kTruePathAndDepth, .in_tables = true},
      {.key = "trajectory.drift_percent", .unit = "%", .needs = kTruePath},
      {.key = "trajectory.rpe.*.trans_percent", .unit = "%", .needs = kTruePath},
      {.key = "trajectory.rpe.*.trans_rmse_m", .unit = "m", .needs = kTruePath},
      {.key = "trajectory.rpe.*.rot_deg_per_m", .unit = "deg/m", .needs = kTruePath},
      {.key = "trajectory.rpe.*.pairs", .better = kNeither, .needs = kTruePath},
      {.key = "trajectory.aligned_freedoms", .label = "aligned freedoms", .better = kNeither,
       .needs = "trajectory without a given start, ground truth", .in_tables = true},
      {.key = "trajectory.poses", .better = kNeither, .needs = "trajectory"},
      {.key = "trajectory.duration_s", .unit = "s", .better = kNeither, .needs = "ground truth"},
      {.key = "trajectory.path_length_m", .unit = "m", .better = kNeither,
       .needs = "ground truth"},
      {.key = "trajectory.mean_depth_m", .unit = "m", .better = kNeither,
       .needs = "mean scene depth"},
  };
}

std::vector<MetricInfo> depth_rows() {
  return {
      {.key = "depth.rel_mean", .label = "mean depth error", .scale = 100, .needs = kTrueDepth,
       .floor = 0.0001, .in_tables = true, .in_figures = true},
      {.key = "depth.rel_median", .label = "median depth error", .scale = 100, .needs = kTrueDepth,
       .floor = 1e-5, .board = "depth, median relative error", .in_tables = true,
       .in_figures = true},
      {.key = "depth.outlier_5_percent", .scale = 100, .needs = kTrueDepth, .floor = 0.001},
      {.key = "depth.completeness", .label = "completeness", .scale = 100, .better = kHigher,
       .needs = "depth maps, true depth, frames", .floor = 0.01, .board = "depth, completeness",
       .in_tables = true, .in_figures = true},
      {.key = "depth.*rel_mean*", .scale = 100, .needs = kTrueDepth},
      {.key = "depth.*rel_median*", .scale = 100, .needs = kTrueDepth},
      {.key = "depth.*outlier_5_percent*", .scale = 100, .needs = kTrueDepth},
      {.key = "depth.views.completeness.*", .scale = 100, .better = kHigher,
       .needs = "depth maps, true depth, frames"},
      {.key = "depth.*rmse_m", .unit = "m", .needs = kTrueDepth},
      {.key = "depth.*delta_1_25", .better = kHigher, .needs = kTrueDepth},
      {.key = "depth.*within_*_sigma", .scale = 100, .better = kNeither,
       .needs = "depth maps, true depth, sigmas of the depth"},
      {.key = "depth.*points*", .better = kNeither, .needs = "depth maps"},
      {.key = "depth.views.count", .better = kNeither, .needs = "depth maps"},
      {.key = "depth.two_planes.angle_deg", .unit = "deg", .better = kNeither,
       .needs = "depth maps"},
      {.key = "depth.two_planes.share", .scale = 100, .better = kHigher, .needs = "depth maps"},
  };
}

std::vector<MetricInfo> image_rows() {
  return {
      {.key = "reconstruction.ssim", .label = "SSIM", .better = kHigher, .needs = kTrueFrames,
       .floor = 0.01, .board = "images, SSIM", .in_tables = true, .in_figures = true},
      {.key = "reconstruction.mse", .label = "MSE", .needs = kTrueFrames, .in_tables = true,
       .in_figures = true},
      {.key = "reconstruction.pearson", .better = kHigher, .needs = kTrueFrames, .floor = 0.01},
      {.key = "reconstruction.rmse_log", .needs = kTrueFrames, .floor = 0.001},
      {.key = "reconstruction.observed", .scale = 100, .better = kHigher, .needs = kTrueFrames,
       .floor = 0.01},
      {.key = "reconstruction.gradient_pearson", .better = kHigher, .needs = kTrueFrames},
      {.key = "reconstruction.worst.*", .better = kHigher, .needs = kTrueFrames},
      {.key = "reconstruction.fit.*", .better = kNeither, .needs = kTrueFrames},
      {.key = "reconstruction.views", .better = kNeither, .needs = "images"},
  };
}

std::vector<MetricInfo> rotation_rows() {
  return {
      {.key = "orientation.roll_pitch_rmse_deg", .label = "roll and pitch [deg]", .unit = "deg",
       .needs = "orientations, ground truth", .floor = 0.001,
       .board = "roll and pitch, RMSE", .in_tables = true},
      {.key = "orientation.rate_rmse_rad_s", .label = "rate [rad/s]", .unit = "rad/s",
       .needs = "angular velocities, true twists or a gyroscope", .floor = 0.0001,
       .board = "angular velocity, RMSE", .in_tables = true},
      {.key = "orientation.rate_rmse_percent", .unit = "%",
       .needs = "angular velocities, true twists or a gyroscope"},
      {.key = "orientation.rate_peak_rad_s", .unit = "rad/s", .better = kNeither,
       .needs = "angular velocities, true twists or a gyroscope"},
      {.key = "orientation.yaw_drift_deg_per_min", .unit = "deg/min",
       .needs = "orientations, ground truth"},
      {.key = "orientation.bias_error_rad_s", .unit = "rad/s",
       .needs = "gyroscope biases, true biases"},
      {.key = "orientation.bias_sigma_rad_s", .unit = "rad/s", .better = kNeither,
       .needs = "gyroscope biases"},
      {.key = "stabilization.within_1px", .scale = 100, .better = kHigher,
       .needs = "stabilized events, ground truth", .floor = 0.01},
      {.key = "sharpness.stabilized", .label = "sharpness", .better = kHigher,
       .needs = "stabilized events", .board = "sharpness of the stabilized view",
       .in_tables = true},
      {.key = "sharpness.fwl", .better = kHigher, .needs = "stabilized events"},
      {.key = "sharpness.raw", .better = kNeither, .needs = "stabilized events"},
      {.key = "sharpness.truth", .better = kNeither, .needs = "stabilized events, ground truth"},
      {.key = "mosaic.ssim", .label = "mosaic SSIM", .better = kHigher, .needs = kTruePanorama,
       .floor = 0.01, .board = "mosaic, SSIM", .in_tables = true},
      {.key = "mosaic.pearson", .better = kHigher, .needs = kTruePanorama, .floor = 0.01},
      {.key = "mosaic.alignment.residual_deg", .unit = "deg", .needs = kTruePanorama,
       .floor = 0.001},
      {.key = "mosaic.alignment.rotation_deg", .unit = "deg", .needs = kTruePanorama},
      {.key = "mosaic.mse", .needs = kTruePanorama},
      {.key = "mosaic.rmse_log", .needs = kTruePanorama},
      {.key = "mosaic.gradient_pearson", .better = kHigher, .needs = kTruePanorama},
      {.key = "mosaic.aligned.*", .better = kHigher, .needs = kTruePanorama},
      {.key = "mosaic.observed", .scale = 100, .better = kHigher, .needs = kTruePanorama},
      {.key = "mosaic.span.*", .better = kHigher, .needs = "mosaic"},
      {.key = "mosaic.fit.*", .better = kNeither, .needs = kTruePanorama},
  };
}

std::vector<MetricInfo> event_rows() {
  return {
      {.key = "events.precision_10us", .label = "precision at 10 us", .scale = 100,
       .better = kHigher, .needs = kTwoStreams, .floor = 0.001, .board = "events, precision"},
      {.key = "events.recall_10us", .label = "recall at 10 us", .scale = 100,
       .better = kHigher, .needs = kTwoStreams, .floor = 0.001, .board = "events, recall"},
      {.key = "events.median_dt_us", .label = "median |dt| [us]", .unit = "us", .needs = kTwoStreams, .floor = 0.1},
      {.key = "events.median_signed_dt_us", .unit = "us", .better = kNeither,
       .needs = kTwoStreams},
      {.key = "events.p99_dt_us", .label = "99 % of |dt| [us]", .unit = "us", .needs = kTwoStreams, .floor = 1},
      {.key = "events.ratio", .label = "count ratio", .better = kNeither, .needs = kTwoStreams},
      {.key = "events.*ratio", .better = kNeither, .needs = kTwoStreams},
      {.key = "events.*count", .better = kNeither, .needs = kTwoStreams},
      {.key = "events.precision_1us", .label = "precision at 1 us", .scale = 100,
       .better = kHigher, .needs = kTwoStreams},
      {.key = "events.recall_1us", .label = "recall at 1 us", .scale = 100, .better = kHigher,
       .needs = kTwoStreams},
      {.key = "events.precision_100us", .label = "precision at 100 us", .scale = 100,
       .better = kHigher, .needs = kTwoStreams},
      {.key = "events.recall_100us", .label = "recall at 100 us", .scale = 100,
       .better = kHigher, .needs = kTwoStreams},
      {.key = "events.origin.*", .scale = 100, .better = kHigher,
       .needs = "two streams of events, labels"},
      {.key = "events.*precision_*", .scale = 100, .better = kHigher, .needs = kTwoStreams},
      {.key = "events.*recall_*", .scale = 100, .better = kHigher, .needs = kTwoStreams},
  };
}

std::vector<MetricInfo> other_rows() {
  return {
      {.key = "keyframes.jump_percent.*", .unit = "%",
       .needs = "keyframes, ground truth, mean scene depth"},
      {.key = "keyframes.jump_deg.*", .unit = "deg", .needs = "keyframes, ground truth"},
      {.key = "keyframes.count", .better = kNeither, .needs = "keyframes"},
      {.key = "refined_ratio.*", .needs = "a run of refine over the same dataset"},
  };
}

std::vector<MetricInfo> speed_rows() {
  return {
      {.key = "speed.poses_per_s", .label = "poses/s", .unit = "1/s", .better = kHigher,
       .needs = kTiming, .in_tables = true, .in_figures = true, .is_speed = true},
      {.key = "speed.events_per_s", .label = "events/s", .unit = "1/s", .better = kHigher,
       .needs = kTiming, .in_tables = true, .is_speed = true},
      {.key = "speed.realtime_factor", .label = "x real time", .better = kHigher, .needs = kTiming,
       .board = "speed, x real time", .in_tables = true, .is_speed = true},
      {.key = "speed.wall_s", .unit = "s", .scale = 1000, .needs = kTiming, .is_speed = true},
      {.key = "speed.events", .label = "processed events", .better = kNeither, .needs = kTiming,
       .in_tables = true, .is_speed = true},
      {.key = "speed.poses", .better = kNeither, .needs = kTiming, .is_speed = true},
      {.key = "speed.repetitions", .better = kNeither, .needs = kTiming, .is_speed = true},
      {.key = "speed.poses_per_s.*", .unit = "1/s", .better = kHigher, .needs = kTiming,
       .is_speed = true},
      {.key = "speed.events_per_s.*", .unit = "1/s", .better = kHigher, .needs = kTiming,
       .is_speed = true},
      {.key = "speed.realtime_factor.*", .better = kHigher, .needs = kTiming, .is_speed = true},
      {.key = "speed.wall_s.*", .unit = "s", .scale = 1000, .needs = kTiming, .is_speed = true},
      {.key = "speed.stages_s.*", .unit = "s", .scale = 1000, .needs = kTiming, .is_speed = true},
      {.key = "speed.io_s", .unit = "s", .scale = 1000, .needs = kTiming, .is_speed = true},
      {.key = "speed.cpu_s", .unit = "s", .needs = kTiming, .is_speed = true},
      {.key = "speed.peak_memory_mb", .unit = "MB", .needs = kTiming, .is_speed = true},
      {.key = "speed.latency_ms.*", .unit = "ms", .needs = kTiming, .is_speed = true},
      {.key = "speed.dropped_events", .needs = kTiming, .is_speed = true},
  };
}

std::vector<MetricInfo> dataset_rows() {
  return {
      {.key = "dataset.events", .label = "events", .better = kNeither, .needs = kDataset,
       .in_tables = true, .in_figures = true},
      {.key = "dataset.duration_s", .label = "duration [s]", .unit = "s", .better = kNeither,
       .needs = kDataset, .in_tables = true},
      {.key = "dataset.mean_scene_depth_m", .label = "mean depth [m]", .unit = "m",
       .better = kNeither, .needs = kDataset, .in_tables = true},
      {.key = "dataset.path_length_m", .label = "path [m]", .unit = "m", .better = kNeither,
       .needs = kDataset, .in_tables = true},
      {.key = "dataset.rays_per_event", .label = "rays per event", .better = kNeither,
       .needs = kDataset, .in_tables = true},
      {.key = "dataset.time_bound_us", .label = "time bound [us]", .unit = "us",
       .better = kNeither, .needs = kDataset, .in_tables = true},
  };
}
// clang-format on

/// Whether `pattern` becomes `text` where each '*' is replaced by some text, which may be empty.
bool matches(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  pattern.remove_prefix(star + 1);
  for (std::size_t skipped = star; skipped <= text.size(); ++skipped)
    if (matches(pattern, text.substr(skipped))) return true;
  return false;
}

}  // namespace

std::span<const MetricInfo> metric_catalogue() {
  static const std::vector<MetricInfo> catalogue = [] {
    std::vector<MetricInfo> all;
    for (const auto& part : {trajectory_rows(), depth_rows(), image_rows(), rotation_rows(),
                             event_rows(), other_rows(), speed_rows(), dataset_rows()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return catalogue;
}

namespace {

/// nullptr where there is none.
const MetricInfo* row_of(std::string_view key) {
  const std::span<const MetricInfo> all = metric_catalogue();
  auto row = std::find_if(all.begin(), all.end(),
                          [&](const MetricInfo& metric) { return metric.key == key; });
  if (row == all.end())
    row = std::find_if(all.begin(), all.end(),
                       [&](const MetricInfo& metric) { return matches(metric.key, key); });
  return row == all.end() ? nullptr : &*row;
}

}  // namespace

bool is_catalogued(std::string_view key) { return row_of(key) != nullptr; }

Metrics catalogued(Metrics metrics) {
  for (const auto& [key, value] : metrics.values())
    SACCADE_CHECK(key.starts_with("speed.") || is_catalogued(key));
  return metrics;
}

MetricInfo metric_info(std::string_view key) {
  const MetricInfo* row = row_of(key);
  MetricInfo metric = row == nullptr ? MetricInfo{} : *row;
  metric.key = key;
  if (metric.label.empty()) metric.label = key;
  return metric;
}

std::span<const MetricInfo> default_metrics() {
  static const std::vector<MetricInfo> metrics = [] {
    std::vector<MetricInfo> shown;
    std::copy_if(metric_catalogue().begin(), metric_catalogue().end(), std::back_inserter(shown),
                 [](const MetricInfo& metric) { return metric.in_tables; });
    return shown;
  }();
  return metrics;
}

std::string MetricInfo::shown_unit() const {
  if (scale == 1) return unit;
  return unit.empty() ? "%" : "m" + unit;
}

std::optional<double> shown_value(const Metrics& metrics, const std::string& key) {
  const std::optional<double> value = metrics.get(key);
  return value ? std::optional(*value * metric_info(key).scale) : std::nullopt;
}

}  // namespace saccade
