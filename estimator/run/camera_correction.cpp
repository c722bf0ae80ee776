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
             "fx and fy are taken to be so many times those of the calibration")
      .range(0.1, 10);
}

}  // namespace saccade
