#include "estimator/depth/depth_config.h"

#include "core/check.h"
#include "estimator/depth/ray_depth_config.h"

namespace saccade {
namespace {

void describe_limits(config::Fields& fields, DepthLimits& limits) {
  fields.value("near", limits.near_m, "nearest depth").range(1e-3, 1e6);
  fields.value("far", limits.far_m, "farthest depth").range(1e-3, 1e6);
  fields.expect(limits.near_m < limits.far_m, "near", "must be below far");
}

void describe_keypoints(config::Fields& fields, KeypointOptions& options) {
  fields.value("cell_px", options.cell_px, "side of a cell, which has at most one keypoint (5.5)")
      .range(1, 1000);
  fields
      .value("min_weight", options.min_weight,
             "of a cell, in units of the mean over the reference frame")
      .range(0, 1e6);
}

void describe_search(config::Fields& fields, SearchOptions& options) {
  fields
      .value("patch_radius_px", options.patch_radius_px, "a patch has 2 r + 1 pixels on each side")
      .range(1, 50);
  fields.value("iterations", options.iterations, "of Gauss-Newton, at most").range(1, 1000);
  fields
      .value("max_shift_px", options.max_shift_px,
             "farther along the line from where the current depth puts it, a match is refused")
      .above(0);
  fields
      .value("min_alignment", options.min_alignment,
             "a patch is refused when the mean cos^2 between its gradient and the line is less")
      .range(0, 1);
  fields.value("min_correlation", options.min_correlation, "of the matched patches").range(-1, 1);
}

void describe_filter(config::Fields& fields, FilterOptions& options) {
  fields.value("error_px", options.error_px, "deviation of a match along the epipolar line")
      .range(0.001, 100);
  fields.value("prior_inliers", options.prior_inliers, "a of a new keypoint").range(0.1, 1e6);
  fields.value("prior_outliers", options.prior_outliers, "b of a new keypoint").range(0.1, 1e6);
  fields
      .value("converged", options.converged,
             "a point counts when the deviation of its inverse depth is below this share of it")
      .above(0);
  fields.value("min_inlier_probability", options.min_inlier_probability, "a point counts above it")
      .range(0, 1);
}

void describe_outliers(config::Fields& fields, OutlierOptions& options) {
  fields.value("radius", options.radius, "of the neighbourhood, as a share of the point's depth")
      .above(0);
  fields.value("neighbours", options.neighbours, "least other points in it; 0 keeps everything")
      .range(0, 1000);
}

void describe_thesis(config::Fields& fields, ThesisDepthOptions& options) {
  fields
      .value("events_per_px", options.events_per_px,
             "events of an event frame, per pixel of the sensor (5.4)")
      .range(0.001, 100);
  fields.group(
      "keypoints", [&](config::Fields& f) { describe_keypoints(f, options.keypoints); },
      "grid over the reference frame (5.5)");
  fields.group(
      "search", [&](config::Fields& f) { describe_search(f, options.search); },
      "Lucas-Kanade along the epipolar line (5.1)");
  fields.group(
      "filter", [&](config::Fields& f) { describe_filter(f, options.filter); },
      "Bayesian filter of the inverse depth (5.3)");
  fields.group(
      "outliers", [&](config::Fields& f) { describe_outliers(f, options.outliers); },
      "radius outlier removal");
  fields
      .value("initial_depth_m", options.initial_depth_m,
             "where keypoints start; ~ is the dataset's mean scene depth")
      .above(0);
}

void describe_sweep(config::Fields& fields, SweepDepthOptions& options) {
  fields.value("planes", options.planes, "of equal steps in inverse depth").range(2, 10000);
  fields
      .value("threshold_side_px", options.threshold_side,
             "of the Gaussian neighbourhood of the adaptive threshold, odd")
      .range(3, 99);
  fields.expect(options.threshold_side % 2 == 1, "threshold_side_px", "must be odd");
  fields
      .value("threshold", options.threshold,
             "votes above the neighbourhood's mean; the most are 255")
      .range(-255, 255);
  fields.value("median_side_px", options.median_side, "of the median, odd; 1: none").range(1, 99);
  fields.expect(options.median_side % 2 == 1, "median_side_px", "must be odd");
  fields.group(
      "outliers", [&](config::Fields& f) { describe_outliers(f, options.outliers); },
      "radius outlier removal");
}

}  // namespace

void describe_depth_method(config::Fields& fields, DepthConfig& config) {
  fields.choice("method", config.method,
                {{"thesis", DepthConfig::Method::kThesis},
                 {"rays", DepthConfig::Method::kRays},
                 {"sweep", DepthConfig::Method::kSweep}},
                "how depth is found");
  fields.group(
      "range_m", [&](config::Fields& f) { describe_limits(f, config.limits); },
      "depths that may occur");
  if (config.method == DepthConfig::Method::kThesis)
    fields.group(
        "thesis", [&](config::Fields& f) { describe_thesis(f, config.thesis); },
        "keypoints of a reference frame, searched along epipolar lines (chapter 5)");
  if (config.method == DepthConfig::Method::kRays)
    fields.group(
        "rays", [&](config::Fields& f) { describe(f, config.rays); },
        "seeds of a sweep, each with a regression over the rays near it");
  if (config.method == DepthConfig::Method::kSweep)
    fields.group(
        "sweep", [&](config::Fields& f) { describe_sweep(f, config.sweep); },
        "votes on planes of inverse depth");
}

void describe(config::Fields& fields, DepthConfig& config) {
  describe_depth_method(fields, config);
  fields.group(
      "window", [&](config::Fields& f) { describe(f, config.window); },
      "part of the events that makes one view");
  fields.value("seed", config.seed, "of random numbers; no method draws any yet");
}

std::unique_ptr<DepthEstimator> make_depth_estimator(const DepthConfig& config,
                                                     const PinholeCamera& camera,
                                                     double mean_depth_m) {
  SACCADE_CHECK(mean_depth_m > 0);
  switch (config.method) {
    case DepthConfig::Method::kThesis:
      return std::make_unique<ThesisDepth>(config.thesis, config.limits, camera, mean_depth_m);
    case DepthConfig::Method::kRays:
      return std::make_unique<RayDepth>(config.rays, config.limits, camera);
    case DepthConfig::Method::kSweep:
      return std::make_unique<SweepDepth>(config.sweep, config.limits, camera);
  }
  return nullptr;
}

}  // namespace saccade
