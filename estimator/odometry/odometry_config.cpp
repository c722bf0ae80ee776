#include "estimator/odometry/odometry_config.h"

#include "estimator/refinement/joint_config.h"
#include "estimator/tracking/track_config.h"

namespace saccade {
namespace {

void describe_found_start(config::Fields& fields, BootstrapOptions& options) {
  fields
      .value("depth_m", options.depth_m,
             "the typical depth of the start is called so: events alone do not say the scale")
      .above(0);
  fields
      .value("motion_px", options.plane.motion_px,
             "image motion over the first part of it, as before a plane")
      .range(8, 1000);
  fields.value("window_s", options.window_s, "of the path that is found, at most").range(0.01, 10);
}

void describe_start(config::Fields& fields, StartOptions& options) {
  fields
      .value("truth_s", options.truth_s,
             "the poses are given for so long from the first event on; no later one is read; 0: "
             "none is, the start is found from events alone")
      .range(0, 1e3);
  if (options.truth_s == 0) {
    describe_found_start(fields, options.found);
    return;
  }
  fields
      .value("truth_share", options.truth_share, "... but for no more than this share of the whole")
      .above(0)
      .at_most(1);
  fields
      .value("time_offset_s", options.time_offset_s,
             "a given pose is that of so long after its time stamp")
      .range(-1, 1);
}

void describe_keyframe(config::Fields& fields, OdometryOptions& options) {
  KeyframeOptions& keyframe = options.keyframe;
  fields
      .value("distance", keyframe.distance,
             "d_kf: way after which a keyframe is made, as a share of the typical depth")
      .range(1e-3, 100);
  fields
      .value("min_visible", keyframe.min_visible,
             "it is made, too, when less than this share of the last one's edges is in view")
      .range(0, 1);
  fields.value("interval_s", keyframe.interval_s, "least time from one to the next").range(0, 1e3);
  fields
      .value(
          "handover_s", keyframe.handover_s,
          "from its newest event to the last that is tracked without it; 0: tracking waits for it")
      .range(0, 1e3);
  fields
      .value("unsettled_s", keyframe.unsettled_s,
             "the poses of its last seconds may still change with the next")
      .range(0, 1e3);
  fields
      .value("active", options.map.active,
             "so many make up the map: the newest and those that show most of what is seen")
      .range(1, 1000);
}

void describe_mapping(config::Fields& fields, MappingOptions& options) {
  using Edges = MappingOptions::Edges;
  using View = MappingOptions::View;
  fields.value("events", options.events, "N_map: a keyframe is made of at most so many")
      .range(100, 1e9);
  fields.value("duration_s", options.duration_s, "... and of at most so long").range(1e-3, 1e3);
  fields.choice("view", options.view, {{"middle", View::kMiddle}, {"end", View::kEnd}},
                "where in its events the view lies");
  fields.choice("edges", options.edges, {{"gradient", Edges::kGradient}, {"depth", Edges::kDepth}},
                "what the camera is tracked by: steep pixels of the reconstruction, or the points "
                "with depth");
  if (options.edges == Edges::kGradient)
    fields.group(
        "steep", [&](config::Fields& f) { describe(f, options.steep); },
        "which pixels those are (4.4)");
  if (options.edges == Edges::kDepth) {
    fields
        .value(
            "thinned_to", options.thinned_to,
            "depth is found from about so many of the window's events: those of some of the pixels")
        .range(100, 1e9);
    fields
        .value("max_sigma", options.max_sigma,
               "deviation of a point's depth up to which it is tracked, relative")
        .above(0);
    fields
        .value(
            "min_edges", options.min_edges,
            "with fewer, less certain ones are tracked, too, of up to 9 times the deviation here "
            "and in depth.rays, and given poses that show fewer are carried on by the events "
            "after them")
        .range(0, 1e6);
    fields.value("image", options.image, "an image is made, too, for people; after the last event");
  }
  fields
      .value("smoothing_s", options.smoothing_s,
             "spacing of the knots of a spline through the tracked poses; 0: none")
      .range(0, 10);
}

void describe_adjustment(config::Fields& fields, MappingOptions& options) {
  AdjustmentOptions& adjustment = options.adjustment;
  fields
      .value("rounds", options.adjust_rounds,
             "of finding edges and adjusting them with the poses; 0: poses are taken as tracked")
      .range(0, 100);
  fields
      .value("node_spacing_s", adjustment.node_spacing_s,
             "the correction of the poses is linear between nodes")
      .range(1e-4, 100);
  fields.value("edges", adjustment.edges, "at most so many").range(30, 1e7);
  fields.value("pairs", adjustment.pairs, "of an edge's events between two nodes, at most")
      .range(1, 1e6);
  fields
      .value("given_pairs", adjustment.given_pairs,
             "the same while the poses are given, which tells the scale")
      .range(1, 1e6);
  fields
      .value(
          "landmark_px", adjustment.landmark_px,
          "what an edge is off by from that of an older keyframe on which it lies; 0: those hold "
          "nothing")
      .range(0, 100);
  fields.value("landmark_depth", adjustment.landmark_depth, "the same in depth, relative").above(0);
  fields.value("noise_px", adjustment.noise_px, "least deviation of an event from its edge")
      .range(1e-3, 10);
  fields.value("outlier", adjustment.outlier, "deviations beyond which an event counts less")
      .range(0.1, 1e6);
  fields.value("iterations", adjustment.iterations, "of Levenberg-Marquardt, at most")
      .range(1, 1000);
  using Deviations = AdjustmentOptions::Deviations;
  fields.choice("deviations", adjustment.deviations,
                {{"picture", Deviations::kPicture}, {"pose", Deviations::kPose}},
                "whether poses may be off by more in what hardly moves the picture");
  fields.value("pose_sigma_px", adjustment.pose_sigma_px, "of poses, as image motion").above(0);
  fields.value("step_sigma_px", adjustment.step_sigma_px, "of the correction from node to node")
      .above(0);
  fields.value("known_sigma_px", adjustment.known_sigma_px, "of poses that are settled").above(0);
  fields
      .value("surface_sigma", adjustment.surface_sigma,
             "of the edges from a smooth surface, relative; 0: edges are on their own")
      .range(0, 10);
  fields.value("surface_spacing_px", adjustment.surface_spacing_px, "between the surface's nodes")
      .range(2, 1000);
}

void describe_last(config::Fields& fields, LastAdjustment& last) {
  fields.value("use", last.use, "it is made");
  if (last.use) describe(fields, last.joint);
}

void describe_inertial(config::Fields& fields, MetricWorldOptions& options) {
  fields.value("align", options.align,
               "scale, gravity, biases and time offset by gyroscope and accelerometer, once the "
               "path is found; without given poses the run is then in metres and upright");
  if (!options.align) return;
  InertialAlignmentOptions& alignment = options.alignment;
  fields.value("gravity", alignment.gravity, "[m/s^2]").above(0);
  fields.value("interval_s", alignment.interval_s, "readings are summed up over so long")
      .range(0.02, 10);
  fields
      .value("smoothing_s", alignment.smoothing_s,
             "spacing of the knots of a spline through the path")
      .range(1e-3, 10);
  fields
      .value("position_sigma", options.position_sigma,
             "of a pose of the path, as a share of the typical depth")
      .above(0);
  fields.value("tilt_sigma_rad", alignment.tilt_sigma_rad, "of its orientation").above(0);
  fields.value("accel_bias_sigma", alignment.accel_bias_sigma, "of the accelerometer's bias")
      .above(0);
  fields
      .value("max_scale_sigma", alignment.max_scale_sigma,
             "a scale that is known less, relative, is not used")
      .above(0);
  fields
      .value("max_residual", alignment.max_residual,
             "a path that the readings fit worse, over the deviations above, stays as it is")
      .above(0);
  fields.value("outlier", alignment.outlier, "deviations beyond which an interval counts less")
      .range(0.1, 1e6);
}

}  // namespace

void describe(config::Fields& fields, OdometryConfig& config) {
  using config::Fields;
  OdometryOptions& odometry = config.odometry;
  fields.section("camera", config.camera, "what is taken to differ from the calibration");
  fields.group(
      "start", [&](Fields& f) { describe_start(f, config.start); }, "what is known at the start");
  fields.choice("mode", odometry.mode,
                {{"offline", OdometryMode::kOffline}, {"online", OdometryMode::kOnline}},
                "events are worked through with the same result on any machine, or played as they "
                "were recorded");
  if (odometry.mode == OdometryMode::kOnline)
    fields.group(
        "online",
        [&](Fields& f) {
          f.value("max_age_ms", odometry.online.max_age_ms,
                  "when a frame's events are older before it is begun, all that have arrived are "
                  "dropped")
              .above(0);
        },
        "of mode: online");
  fields.group(
      "keyframe", [&](Fields& f) { describe_keyframe(f, odometry); }, "when the map is renewed");
  fields.group(
      "relocation",
      [&](Fields& f) {
        f.value("every_s", odometry.relocation.every_s,
                "a lost camera is looked for at the keyframes so often; 0: never")
            .range(0, 1e3);
        f.value("looks_back_s", odometry.relocation.looks_back_s,
                "and first where it was so long before")
            .range(0, 1e3);
        f.value("when_unlike", odometry.relocation.when_unlike,
                "it is looked for, too, where the map explains much less of the frames than usual");
      },
      "what happens after the camera was lost");
  fields.group(
      "mapping", [&](Fields& f) { describe_mapping(f, odometry.mapping); },
      "what a keyframe is made of");
  fields.group(
      "adjustment", [&](Fields& f) { describe_adjustment(f, odometry.mapping); },
      "of the poses and edges of a keyframe, together; of depth.method: rays");
  fields.group(
      "depth", [&](Fields& f) { describe_depth_method(f, odometry.mapping.depth); },
      "as of saccade run depth");
  // Where it is stated, too, so that switching the images off is one change.
  if (odometry.mapping.image || odometry.mapping.edges == MappingOptions::Edges::kGradient ||
      fields.has("reconstruction"))
    fields.group(
        "reconstruction",
        [&](Fields& f) { describe_reconstruction_method(f, odometry.mapping.reconstruction); },
        "as of saccade run reconstruct");
  fields.group(
      "tracking", [&](Fields& f) { describe(f, odometry.tracker); },
      "as of saccade run track, method: edges");
  fields.expect(odometry.mapping.adjust_rounds == 0 ||
                    odometry.mapping.depth.method == DepthConfig::Method::kRays,
                "adjustment", "rounds need depth.method: rays");
  fields.group(
      "last", [&](Fields& f) { describe_last(f, odometry.last); },
      "adjustment of the whole path and the edges of all keyframes, after the last event; of mode: "
      "offline, where no pose was lost");
  fields.expect(
      !odometry.last.use || (odometry.mapping.depth.method == DepthConfig::Method::kRays &&
                             odometry.mapping.edges == MappingOptions::Edges::kDepth),
      "last", "needs depth.method: rays and mapping.edges: depth");
  const ReconstructionConfig& reconstruction = odometry.mapping.reconstruction;
  fields.expect(reconstruction.contrast_on && reconstruction.contrast_off, "reconstruction",
                "contrast_on and contrast_off must be stated: nothing comes from the dataset");
  fields.group(
      "imu", [&](Fields& f) { describe_inertial(f, config.metric); }, "metres and upright");
  fields.value("seed", config.seed, "of the samples");
}

}  // namespace saccade
