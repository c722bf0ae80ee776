#include "estimator/imu/stabilize_config.h"

namespace saccade {

void describe(config::Fields& fields, StabilizeConfig& config) {
  fields.section("orientation", config.orientation,
                 "Orientation from the inertial sensor. Not used with --poses-from.");
  fields
      .value("smoothing_time_s", config.smoothing.time_constant_s,
             "Time constant of the low-pass filter of the steady orientation, in seconds. Larger "
             "values remove slower motion; 0.4 corresponds to the thesis's 0.1 per frame (3.18).")
      .range(1e-4, 1e6);
  fields.value("lock_roll", config.smoothing.lock_roll,
               "Keeps the rows of the stabilized image horizontal.");
  fields
      .value("max_angle_deg", config.smoothing.max_angle_deg,
             "Largest angle between the camera and the steady orientation, in degrees. Beyond it "
             "the steady orientation follows the camera, so that the view stays in the image.")
      .range(0.01, 180);
  fields
      .value("window_s", config.window_s,
             "Length of a window of events that are rotated to one steady orientation, in "
             "seconds.")
      .range(1e-4, 1e4);
  fields.value("frames", config.frames, "Stabilizes the grey frames of the dataset as well.");
  fields.value("seed", config.seed,
               "Seed of the run. It changes nothing here: no random numbers are drawn.");
}

}  // namespace saccade
