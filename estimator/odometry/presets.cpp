#include "estimator/odometry/presets.h"

#include "core/config/method_table.h"

namespace saccade {
namespace {

/// Tracking by keyframes: the accurate setting of `saccade run track`; `event_map_ratio` is r of
/// (4.21).
EdgeTrackerOptions tracking_by_keyframes(double event_map_ratio) {
  EdgeTrackerOptions tracking;
  tracking.event_frame.event_map_ratio = event_map_ratio;
  return tracking;
}

/// Depth of keyframes by regression over event rays. Less certain points than those of `saccade run
/// depth` (configs/depth/best.yaml: 2 %, two neighbours, 1.2 %) are kept: the camera is tracked by
/// their number more than by their precision.
DepthConfig depth_of_keyframes() {
  DepthConfig depth;
  depth.rays.find_delay = false;  // the poses are of the same events
  depth.method = DepthConfig::Method::kRays;
  depth.limits = {.near_m = 0.3, .far_m = 50};
  depth.rays.refiner.max_sigma = 0.03;
  depth.rays.fusion.min_neighbours = 1;
  depth.rays.fusion.max_sigma = 0.05;
  return depth;
}

/// Keyframes of edges with depth, each adjusted together with the poses of its window.
OdometryOptions edges() {
  OdometryOptions options;
  options.keyframe = {.distance = 0.05,
                      .interval_s = 0.1,
                      .doubles_baseline = true,
                      .turn = 0.25,
                      .active_window_s = 0.4,
                      .active = 3};
  options.tracker = tracking_by_keyframes(0.1);
  MappingOptions& mapping = options.mapping;
  mapping.depth = depth_of_keyframes();
  mapping.reconstruction.method = ReconstructionConfig::kEquations;
  // The window is 0.65 s long however many events that is.
  mapping.events = 2000000;
  mapping.duration_s = 0.65;
  mapping.turn = 0.5;
  mapping.view = MappingOptions::View::kMiddle;
  mapping.edges = MappingOptions::Edges::kDepth;
  mapping.min_edges = 600;
  mapping.smoothing_s = 0.01;
  mapping.adjust_rounds = 1;
  options.smoothing.lag_s = 2;
  return options;
}

/// The loop of the thesis (fig. 7.1): a keyframe of depth (chapter 5) and reconstruction (chapter
/// 6), backwards from the newest event, replaces the one before.
OdometryOptions thesis() {
  OdometryOptions options;
  options.keyframe = {.distance = 0.1, .active_window_s = 0.1, .active = 1};
  options.relocation = Relocation::kNever;
  options.tracker = tracking_by_keyframes(0.3);
  MappingOptions& mapping = options.mapping;
  mapping.depth.method = DepthConfig::Method::kThesis;
  mapping.depth.limits = {.near_m = 0.5, .far_m = 50};
  // A keyframe's window is short: points count at three times the usual sigma.
  mapping.depth.thesis.max_sigma = 0.1;
  // Of the edges that `saccade run refine` finds anew to adjust them together with the poses.
  mapping.depth.rays.refiner.max_sigma = 0.015;
  mapping.depth.rays.fusion.max_sigma = 0.02;
  mapping.reconstruction.method = ReconstructionConfig::kGradient;
  mapping.reconstruction.depth.propagation = DepthSourceOptions::Propagation::kSplat;
  mapping.events = 300000;
  mapping.duration_s = 0.4;
  mapping.view = MappingOptions::View::kEnd;
  mapping.edges = MappingOptions::Edges::kGradient;
  // After a short start the gradient of what moved fast is wide and outweighs everything else.
  mapping.steep.thin = true;
  return options;
}

constexpr OdometryMethod kMethods[] = {
    {.name = "edges",
     .help = "Edges with depth by regression over event rays, adjusted together with the poses.",
     .preset = edges},
    {.name = "thesis",
     .help = "Gradients of the reconstruction at the dense depth (fig. 7.1).",
     .preset = thesis}};

}  // namespace

std::span<const OdometryMethod> odometry_methods() { return kMethods; }

OdometryOptions odometry_preset(std::string_view method) {
  return config::find_method(odometry_methods(), method).preset();
}

}  // namespace saccade
