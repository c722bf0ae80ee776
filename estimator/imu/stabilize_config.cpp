#include "estimator/imu/stabilize_config.h"

namespace saccade {
namespace {

void describe_steady(config::Fields& fields, SteadyPoseOptions& options) {
  fields
      .value("time_constant_s", options.time_constant_s,
             "of the low-pass filter; 0.4 is the thesis's 0.1 per frame (3.18)")
      .range(1e-4, 1e6);
  fields.value("lock_roll", options.lock_roll, "rows are kept level");
  fields
      .value("max_angle_deg", options.max_angle_deg,
             "farther from the camera the steady orientation is dragged along")
      .range(0.01, 180);
}

}  // namespace

void describe(config::Fields& fields, StabilizeConfig& config) {
  fields.group(
      "orientation", [&](config::Fields& f) { describe(f, config.orientation); },
      "from the inertial sensor; not used with --poses-from");
  fields.group(
      "steady", [&](config::Fields& f) { describe_steady(f, config.steady); },
      "the orientation that pictures and events are turned to");
  fields.value("window_s", config.window_s, "events of this time are turned to one orientation")
      .range(1e-4, 1e4);
  fields.value("frames", config.frames, "grey frames are stabilized, too");
  fields.value("seed", config.seed, "of random numbers; none are drawn");
}

}  // namespace saccade
