#include "estimator/odometry/odometry_config.h"

#include "core/config/method_table.h"
#include "estimator/odometry/presets.h"
#include "estimator/run/sensor_input.h"

namespace saccade {
namespace {

void describe_start(config::Fields& fields, StartOptions& options) {
  fields
      .value(
          "truth_s", options.truth_s,
          "How long poses of the ground truth are given, in seconds from the first event on, but "
          "at most truth_fraction of the recording; no later one is read. Longer fixes the scale "
          "better. 0 reads none: the start is found from events alone, up to scale.")
      .range(0, 1e3);
  if (fields.is_zero("truth_s", options.truth_s)) {
    fields
        .value("initial_depth_m", options.found.depth_m,
               "The typical depth of the scene at the start, in metres: events alone do not "
               "determine the scale, so this value defines it.")
        .above(0);
    return;
  }
  fields
      .value("truth_fraction", options.truth_fraction,
             "The largest fraction of the recording's time in which poses are given: with a short "
             "recording it counts instead of truth_s.")
      .above(0)
      .at_most(1);
  fields
      .value("time_offset_s", options.time_offset_s,
             "Offset that is added to the time stamps of the given poses, in seconds: negative "
             "where they are stamped late.")
      .range(-1, 1);
}

void describe_keyframe(config::Fields& fields, KeyframeOptions& options) {
  fields
      .value("distance", options.distance,
             "Distance d_kf between the camera and the last keyframe at which a new one is made, "
             "relative to the typical depth. Smaller distances make more keyframes of shorter "
             "baselines.")
      .range(1e-3, 100);
  fields
      .value(
          "interval_s", options.interval_s,
          "The least time between two keyframes, in seconds. It bounds the cost of the mapping "
          "while the camera does not turn away from the map. 0 leaves it to distance alone. With "
          "method edges, while windows are short and depths still poor, a quarter of the time "
          "since the start will do, with smoothing a quarter of the map's baseline in place of the "
          "distance, too, and the few keyframes that double the baseline of a short start are not "
          "counted.")
      .range(0, 1e3);
  fields
      .value("handover_s", options.handover_s,
             "Time from a keyframe's newest event to the last event that is tracked without it, in "
             "seconds. Mapping runs beside the tracking meanwhile; 0 makes tracking wait.")
      .range(0, 1e3);
  fields
      .value("active", options.active,
             "The most keyframes that make up the map: the newest, and of the others those that "
             "show most of what the camera sees. 1 replaces the map by every keyframe.")
      .range(1, 1000);
}

void describe_mapping(config::Fields& fields, MappingOptions& options) {
  fields
      .value("events", options.events,
             "The most events N_map that a keyframe is made of: the newest ones.")
      .range(100, 1e9);
  fields
      .value("duration_s", options.duration_s,
             "The longest time of these events, in seconds. Longer windows have longer baselines "
             "and cost more.")
      .range(1e-3, 1e3);
  fields
      .value("contrast_on", *options.reconstruction.contrast_on,
             "Contrast threshold of ON events, in units of log intensity. It scales the images "
             "alone: nothing is taken from the dataset.")
      .above(0);
  fields
      .value("contrast_off", *options.reconstruction.contrast_off,
             "Contrast threshold of OFF events, in units of log intensity.")
      .above(0);
  if (options.edges == MappingOptions::Edges::kGradient) return;
  fields
      .value("depth_events", options.depth_events,
             "About how many of these events depth is found from: those of a random part of the "
             "pixels. Fewer cost less, whatever the event rate.")
      .range(100, 1e9);
  fields
      .value("min_edges", options.min_edges,
             "With fewer edges in a keyframe, those of no depth are tracked, too, at the one that "
             "edges have in common; a start whose given poses show fewer is extrapolated and "
             "adjusted. Parts of the view that show few certain edges are tracked by less certain "
             "ones. 0 disables all of it.")
      .range(0, 1e6);
  fields.value("image", options.image,
               "Whether an image of every keyframe is reconstructed after the last event. Images "
               "are for people: tracking does not use them.");
}

void describe_adjustment(config::Fields& fields, MappingOptions& options) {
  WindowAdjustmentOptions& adjustment = options.adjustment;
  fields
      .value("rounds", options.adjust_rounds,
             "How often edges are found and adjusted together with the poses of a keyframe's "
             "window. 0 disables the adjustment: the poses stay as tracked.")
      .range(0, 100);
  fields
      .value("edges", adjustment.edges,
             "The most edges that are adjusted. More are more accurate and take longer.")
      .range(30, 1e7);
  fields
      .value("iterations", adjustment.iterations,
             "The most iterations of Levenberg-Marquardt. Fewer bound the time of a keyframe.")
      .range(1, 1000);
}

/// What odometry lets a user set of the options of depth and tracking.
void describe_parts(config::Fields& fields, OdometryOptions& options) {
  using config::Fields;
  describe_depth_range(fields, options.mapping.depth.limits,
                       "Nearest and farthest depth that may occur at a keyframe, in metres, or, "
                       "without given poses, in the unit of start.initial_depth_m.");
  fields.group(
      "tracking",
      [&](Fields& f) {
        MotionModelOptions& motion = options.tracker.motion;
        f.value(
             "event_map_ratio", options.tracker.event_frame.event_map_ratio,
             "Events per frame and template pixel, r of (4.21), but at least 200 events. Smaller "
             "ratios make more and shorter frames of fewer events.")
            .range(1e-4, 100);
        f.choice("prediction", motion.prediction,
                 {{"none", MotionModelOptions::Prediction::kNone},
                  {"constant_velocity", MotionModelOptions::Prediction::kConstantVelocity},
                  {"imu", MotionModelOptions::Prediction::kImu}},
                 "First guess of the next pose: the last one, that at constant velocity, or that "
                 "with the rotation measured by the gyroscope.");
        if (motion.prediction == MotionModelOptions::Prediction::kImu)
          f.value("gyro_bias", motion.gyro_bias,
                  "Bias of the gyroscope, which is subtracted from its samples, in rad/s in the "
                  "sensor's axes.")
              .range(-10, 10);
      },
      "Tracking by keyframes.");
}

}  // namespace

void describe(config::Fields& fields, OdometryConfig& config) {
  using config::Fields;
  OdometryOptions& odometry = config.odometry;
  config::Names<std::string> methods;
  for (const OdometryMethod& row : odometry_methods())
    methods.emplace_back(row.name, std::string(row.name));
  fields.choice("method", config.method, methods,
                config::with_methods("How keyframes are made, which sets the defaults of the keys "
                                     "below.",
                                     odometry_methods()));
  if (fields.reading()) odometry = odometry_preset(config.method);
  if (const auto sensor = describe_sensor(fields, config.sensor)) {
    ReconstructionConfig& images = odometry.mapping.reconstruction;
    if (const auto on = sensor->estimator_contrast_on()) images.contrast_on = on;
    if (const auto off = sensor->estimator_contrast_off()) images.contrast_off = off;
  }
  fields.section("camera", config.camera,
                 "How the camera is assumed to differ from its calibration.");
  fields.group(
      "start", [&](Fields& f) { describe_start(f, config.start); }, "What is given at the start.");
  fields.choice("mode", odometry.mode,
                {{"offline", OdometryMode::kOffline}, {"online", OdometryMode::kOnline}},
                "Whether tracking waits for keyframes, so that the result is the same on any "
                "machine, or events are played at the pace of their recording.");
  fields.group(
      "keyframe", [&](Fields& f) { describe_keyframe(f, odometry.keyframe); },
      "When keyframes are made, and how many make up the map.");
  fields.group(
      "mapping", [&](Fields& f) { describe_mapping(f, odometry.mapping); },
      "What a keyframe is made of.");
  if (odometry.mapping.edges == MappingOptions::Edges::kDepth) {
    fields.group(
        "adjustment", [&](Fields& f) { describe_adjustment(f, odometry.mapping); },
        "Adjustment of the poses and edges of a keyframe's window.");
    fields
        .value(
            "smoothing_s", odometry.smoothing.lag_s,
            "With every keyframe the path of the last seconds is adjusted together with the "
            "edges of all keyframes in it: how long that is. Longer drifts less and costs more; "
            "what is older does not change any more. 0 adjusts the window of the keyframe alone.")
        .range(0, 1e3);
    fields.choice("batch_adjustment", odometry.batch_adjustment,
                  {{"none", BatchMode::kNone},
                   {"events", BatchMode::kEvents},
                   {"events_and_imu", BatchMode::kEventsAndImu}},
                  "Whether the whole path and the edges of all keyframes are adjusted together "
                  "after the last event, with or without the samples of the inertial sensor. Slow. "
                  "Only with mode: offline; skipped if a pose was lost.");
    fields.choice("solver", odometry.mapping.adjustment.solver,
                  {{"structured", BundleSolver::kStructured}, {"ceres", BundleSolver::kCeres}},
                  "What solves the adjustments: the project's own solver, which makes use of their "
                  "structure, or Ceres, its reference, to the same costs and many times slower.");
  }
  describe_parts(fields, odometry);
  fields.value(
      "align_imu", config.align_imu,
      "Whether scale, gravity, biases and time offset are found from gyroscope and "
      "accelerometer after the last event. A run without given poses is then written in "
      "metres and upright; inertial.yaml says where the samples are too few, the motion too "
      "uniform or the path too wrong for that, and the run stays as it is. The shape of the "
      "path stays the same, unlike with batch_adjustment: events_and_imu; the gyroscope "
      "helps to track with tracking.prediction: imu.");
  fields.value("seed", config.seed, "Seed of the random template points of the tracking.");
}

}  // namespace saccade
