#include "estimator/refinement/refinement_config.h"

#include "estimator/refinement/joint_config.h"

namespace saccade {
namespace {

void describe_map(config::Fields& fields, RefinementConfig& config) {
  fields
      .value("turn_deg", config.turn_deg,
             "a further frame joins the map where the view has turned so far from all others; ~: "
             "as in the run")
      .range(1, 180);
  fields.value("edge_step", config.map.edge_step, "steps between pixels that are smoothed [log]")
      .above(0);
  fields.value("blur_px", config.map.blur_px, "deviation of the Gaussian there; 0: none")
      .range(0, 5);
  fields
      .value("contrast", config.contrast,
             "threshold [log units]; ~: the run's, else that of the dataset")
      .range(1e-3, 10);
}

void describe_poses(config::Fields& fields, PoseRefinementOptions& options) {
  using Residual = PoseRefinementOptions::Residual;
  fields.choice("residual", options.residual,
                {{"events", Residual::kEvents}, {"frames", Residual::kFrames}},
                "what is compared with the map: the level at each event, or how much brighter "
                "pixels became over windows of events");
  fields.value("knot_spacing_s", options.knot_spacing_s, "of the cubic spline").range(1e-3, 10);
  if (options.residual == Residual::kEvents) {
    fields.value("events", options.chains.events, "at most so many, all of evenly spread pixels")
        .range(1000, 1e9);
    fields
        .value("chain", options.chains.length,
               "events of a pixel that are compared with each other; 2: neighbours alone")
        .range(2, 1e9);
  } else {
    fields.value("window_events", options.images.window_events, "in a window").range(100, 1e9);
    fields
        .value("increments", options.images.increments,
               "at most so many, all of evenly spread pixels")
        .range(1000, 1e9);
  }
  fields.value("noise", options.noise, "deviation of a level from the map [log units]").above(0);
  fields.value("place_px", options.place_px, "of the place where the map shows it").at_least(0);
  fields
      .value("outlier",
             options.residual == Residual::kEvents ? options.outlier : options.images.outlier,
             "deviations beyond which a residual counts less")
      .range(0.1, 1e6);
  fields.value("hold_px", options.hold_px, "of the control poses from the run's, as image motion")
      .above(0);
  fields.value("rounds", options.rounds, "of finding what each event saw, and adjusting")
      .range(1, 100);
  fields.value("iterations", options.iterations, "of Levenberg-Marquardt in a round, at most")
      .range(1, 1000);
  fields.value("redraw_px", options.redraw_px, "the map is drawn anew after so much motion")
      .range(0.01, 100);
  fields
      .value("information", options.information,
             "of that of independent residuals: neighbouring ones err alike")
      .above(0)
      .at_most(1);
}

void describe_depth(config::Fields& fields, DepthRefinementOptions& options) {
  fields.value("reach_px", options.reach_px, "events so near to an edge, across it, are looked at")
      .range(0.5, 10);
  fields.value("half_length_px", options.half_length_px, "... and along it").range(0.5, 10);
  fields.value("near_px", options.near_px, "of an edge from the run's point where it begins")
      .range(0.1, 10);
  fields.value("same_depth", options.same_depth, "... and of its inverse depth, relative")
      .range(1e-3, 1);
  fields.value("noise_px", options.noise_px, "least deviation of an event from its edge")
      .range(1e-3, 10);
  fields.value("outlier", options.outlier, "deviations beyond which an event counts less")
      .range(0.1, 1e6);
  fields.value("iterations", options.iterations, "of Levenberg-Marquardt, at most").range(1, 1000);
  fields
      .value("information", options.information,
             "of that of independent residuals: neighbouring ones err alike")
      .above(0)
      .at_most(1);
}

}  // namespace

void describe(config::Fields& fields, RefinementConfig& config) {
  using config::Fields;
  using Kind = RefinementConfig::Kind;
  fields.choice(
      "kind", config.kind,
      {{"of_run", Kind::kOfRun},
       {"poses", Kind::kPoses},
       {"depth", Kind::kDepth},
       {"joint", Kind::kJoint}},
      "what is refined; of_run: poses of track, points of depth, both together of odometry");
  const bool is_open = config.kind == Kind::kOfRun;
  if (is_open || config.kind == Kind::kPoses) {
    fields.group(
        "map", [&](Fields& f) { describe_map(f, config); }, "that poses are refined before");
    fields.group(
        "poses", [&](Fields& f) { describe_poses(f, config.poses); }, "of a run of track");
  }
  if (is_open || config.kind == Kind::kDepth)
    fields.group(
        "depth", [&](Fields& f) { describe_depth(f, config.depth); }, "of a run of depth");
  if (is_open || config.kind == Kind::kJoint)
    fields.group(
        "joint", [&](Fields& f) { describe(f, config.joint); },
        "path and edges of a run of odometry");
  fields.value("seed", config.seed, "unused: nothing is drawn at random");
}

}  // namespace saccade
