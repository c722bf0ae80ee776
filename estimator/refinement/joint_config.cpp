#include "estimator/refinement/joint_config.h"

namespace saccade {

void describe(config::Fields& fields, JointRefinementOptions& options) {
  fields.value("knot_spacing_s", options.knot_spacing_s, "of the path and its correction")
      .range(1e-3, 10);
  fields.value("window_s", options.window_s, "of the events in which a keyframe's edges are sought")
      .range(1e-3, 100);
  fields.value("edges", options.edges, "of a keyframe, at most").range(30, 1e7);
  fields.value("events_per_edge", options.events_per_edge, "at most").range(5, 1e6);
  fields.value("noise_px", options.noise_px, "least deviation of an event from its edge")
      .range(1e-3, 10);
  fields.value("outlier", options.outlier, "deviations beyond which an event counts less")
      .range(0.1, 1e6);
  fields.value("hold_px", options.hold_px, "of the correction from none, as image motion").above(0);
  fields.value("known_sigma_px", options.known_sigma_px, "of the given poses of the start")
      .above(0);
  fields.value("rounds", options.rounds, "of finding edges, and adjusting them with the path")
      .range(1, 100);
  fields.value("iterations", options.iterations, "of Levenberg-Marquardt in a round, at most")
      .range(1, 1000);
  fields
      .value("information", options.information,
             "of that of independent residuals: neighbouring ones err alike")
      .above(0)
      .at_most(1);
}

}  // namespace saccade
