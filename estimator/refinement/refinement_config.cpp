#include "estimator/refinement/refinement_config.h"

#include "core/config/method_table.h"

namespace saccade {
namespace {

void describe_poses(config::Fields& fields, RefinementConfig& config) {
  using Residual = PoseRefinementOptions::Residual;
  PoseRefinementOptions& options = config.poses;
  fields.choice("residual", options.residual,
                {{"events", Residual::kEvents}, {"frames", Residual::kFrames}},
                "What is compared with the map: the log intensity at each event, or the brightness "
                "increments of images of many events. Events leave a third to a quarter of the "
                "error.");
  fields
      .value("knot_spacing_s", options.knot_spacing_s,
             "Spacing of the knots of the path's cubic spline, in seconds. Smaller follows faster "
             "motion and leaves fewer events for each control pose.")
      .range(1e-3, 10);
  if (options.residual == Residual::kEvents) {
    fields
        .value("events", options.events,
               "The most events that are used, about: all events of evenly spread pixels. More "
               "average the errors of the map's picture and take longer.")
        .range(1000, 1e9);
    fields
        .value("run_events", options.run_events,
               "The most events of a pixel that share one unknown offset of the log intensity (an "
               "event run); 2, the least, compares neighbouring events alone (run_events: 1 of "
               "reconstruct). Longer runs say more; with a sensor whose thresholds differ between "
               "pixels they drift.")
        .range(2, 1e9);
  } else {
    fields.group(
        "window",
        [&](config::Fields& window) {
          window
              .value("events", options.window_events,
                     "Events over which the brightness increments of an image are summed. More "
                     "events make fewer images.")
              .range(100, 1e9);
        },
        "Part of the events that makes one image of brightness increments.");
  }
  fields
      .value("contrast_on", config.contrast_on,
             "Contrast threshold of ON events, in log units; ~ takes the run's, or else the "
             "dataset's.")
      .range(1e-3, 10);
  fields
      .value("contrast_off", config.contrast_off,
             "Contrast threshold of OFF events, in log units; ~ takes the run's, or else the "
             "dataset's.")
      .range(1e-3, 10);
  fields
      .value(
          "rounds", options.rounds,
          "How often the surface that each event samples is found anew on the refined path. More "
          "rounds help a run that is farther from the optimum and take longer.")
      .range(1, 100);
}

void describe_joint(config::Fields& fields, RefinementConfig& config) {
  BatchAdjustmentOptions& options = config.joint;
  fields
      .value("knot_spacing_s", options.smoothing_s,
             "Spacing of the knots of the spline that smooths the given path, in seconds. Smaller "
             "follows faster motion; larger removes more of the path's jitter.")
      .range(1e-3, 10);
  fields.group(
      "window",
      [&](config::Fields& window) {
        window
            .value("duration_s", options.window_s,
                   "Duration of the window, in seconds. Longer windows overlap more and so reduce "
                   "drift.")
            .range(1e-3, 100);
      },
      "Part of the events around each keyframe in which its edges are found.");
  fields
      .value(
          "edges", options.problem.edges,
          "The most edges of a view that are adjusted; fewer where all views would have more than "
          "100,000 together. More reduce drift and take longer.")
      .range(30, 1e7);
  fields
      .value("reobserved_keyframes", options.problem.reobserved_views,
             "The most later keyframes whose events join the edges that they observe again; 0 "
             "leaves every keyframe to its own window. It bounds the drift of a camera that comes "
             "back and triples the time.")
      .range(0, 1000);
  fields
      .value("rounds", options.rounds,
             "How often edges are found on the refined path and adjusted together with it.")
      .range(1, 100);
  fields.choice("solver", options.problem.solver,
                {{"structured", BundleSolver::kStructured}, {"ceres", BundleSolver::kCeres}},
                "What solves the adjustment: the project's own solver, which makes use of its "
                "structure, or Ceres, its reference, to the same cost and many times slower.");
  fields.value("use_imu", options.use_imu,
               "Whether the samples of gyroscope and accelerometer join in, with gravity, biases "
               "and time offset as further unknowns. Of a run without given poses they determine "
               "the scale, too, and the refined run is in metres and upright.");
}

constexpr RefinementMethod kMethods[] = {
    {.name = "of_run",
     .help = "The method that fits the run's module, with its defaults.",
     .describe = nullptr,
     .module = "",
     .run = nullptr},
    {.name = "poses",
     .help = "All poses of a run of track, against the map that it was tracked by.",
     .describe = describe_poses,
     .module = "track",
     .run = refine_poses},
    {.name = "depth",
     .help = "Every edge of a run of depth, over all events that are its own.",
     .describe = nullptr,
     .module = "depth",
     .run = refine_depth},
    {.name = "joint",
     .help = "Path and edges of a run of odometry, together.",
     .describe = describe_joint,
     .module = "odometry",
     .run = refine_joint},
};

}  // namespace

std::span<const RefinementMethod> refinement_methods() { return kMethods; }

void describe(config::Fields& fields, RefinementConfig& config) {
  config::describe_method(fields, "method", config.method, refinement_methods(), config,
                          "What is refined.");
  fields.value("seed", config.seed, "Without effect: this module draws no random numbers.");
}

}  // namespace saccade
