#pragma once

#include "core/camera.h"
#include "core/config/fields.h"

namespace saccade {

/// A correction of the dataset's calibration: a known error of it, or one whose effect is to be
/// measured.
struct CameraCorrection {
  double focal_scale = 1;

  /// The camera, with the calibration's centre and lens.
  [[nodiscard]] PinholeCamera of(const PinholeCamera& calibrated) const;
};

void describe(config::Fields& fields, CameraCorrection& correction);

}  // namespace saccade
