#include "estimator/run/camera_correction.h"

namespace saccade {

PinholeCamera CameraCorrection::of(const PinholeCamera& calibrated) const {
  PinholeCamera camera = calibrated;
  camera.fx *= focal_scale;
  camera.fy *= focal_scale;
  return camera;
}

void describe(config::Fields& fields, CameraCorrection& correction) {
  fields
      .value("focal_scale", correction.focal_scale,
             "Factor on fx and fy of the calibration: a known error of the lens, or one whose "
             "effect is "
             "to be measured. 1 keeps the calibration.")
      .range(0.1, 10);
}

}  // namespace saccade
