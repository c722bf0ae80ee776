#include "estimator/refinement/joint_config.h"

namespace saccade {
namespace {

void describe_readings(config::Fields& fields, InertialRowsOptions& options) {
  fields.value(
      "use", options.use,
      "gyroscope and accelerometer join in, with gravity, biases and time offset; of a run "
      "without given poses the scale, too");
  if (!options.use) return;
  fields.value("interval_s", options.interval_s, "they are summed up over so long").range(0.02, 10);
  fields.value("bias_spacing_s", options.bias_spacing_s, "biases are even for so long")
      .range(0.1, 1e4);
  fields.value("gyro_bias_step", options.gyro_bias_step, "of one from that before [rad/s]")
      .above(0);
  fields.value("accel_bias_step", options.accel_bias_step, "the same [m/s^2]").above(0);
  fields.value("accel_bias_sigma", options.accel_bias_sigma, "of the first [m/s^2]").above(0);
  fields.value("offset_sigma_s", options.offset_sigma_s, "of the readings' clock").above(0);
  fields.value("slack_rad", options.slack_rad, "of turns that the path's spline cannot follow")
      .above(0);
  fields.value("slack", options.slack, "of places, as a share of the typical depth").above(0);
}

}  // namespace

void describe(config::Fields& fields, JointRefinementOptions& options) {
  fields
      .value("smoothing_s", options.smoothing_s,
             "spacing of the knots of a spline through the given path")
      .range(1e-3, 10);
  fields.value("knot_spacing_s", options.knot_spacing_s, "of the knots of the path's correction")
      .range(1e-3, 10);
  fields.value("window_s", options.window_s, "of the events in which a keyframe's edges are sought")
      .range(1e-3, 100);
  fields.value("edges", options.edges, "of a keyframe, at most").range(30, 1e7);
  fields.value("events_per_edge", options.events_per_edge, "at most").range(5, 1e6);
  fields
      .value("known_events_per_edge", options.known_events_per_edge,
             "at most, beside them, while the poses are given")
      .range(5, 1e6);
  fields
      .value("again_keyframes", options.again_keyframes,
             "that see an edge again, later, and join in; 0: none")
      .range(0, 1000);
  fields.value("again_events", options.again_events, "of each of them, at most").range(1, 1e6);
  fields.value("noise_px", options.noise_px, "least deviation of an event from its edge")
      .range(1e-3, 10);
  fields.value("outlier", options.outlier, "deviations beyond which an event counts less")
      .range(0.1, 1e6);
  fields.value("hold_px", options.hold_px, "of the correction from none, as image motion").above(0);
  fields.value("bend_px", options.bend_px, "of its slope's random walk over a second").above(0);
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
  fields.group(
      "imu", [&](config::Fields& f) { describe_readings(f, options.imu); },
      "readings of the inertial sensor between instants of the path");
}

}  // namespace saccade
