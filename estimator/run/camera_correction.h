#pragma once

#include "core/camera.h"
#include "core/config/fields.h"

namespace saccade {

/// What a run takes the camera for, as against the dataset's calibration: a correction that is
/// known, or an error whose effect is to be measured.
struct CameraCorrection {
  double focal_scale = 1;  ///< fx and fy are so many times those of the calibration

  /// The camera, with the calibration's centre and lens.
  [[nodiscard]] PinholeCamera of(const PinholeCamera& calibrated) const;
};

void describe(config::Fields& fields, CameraCorrection& correction);

}  // namespace saccade
