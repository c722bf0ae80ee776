#pragma once

#include "core/io/dataset/dataset.h"
#include "estimator/tracking/gyroscope.h"
#include "estimator/tracking/motion_model.h"

namespace saccade {

/// The dataset's gyroscope, turned into the frame of the camera by camera.yaml, for
/// motion.prediction: imu; an empty one for any other. InputError where it is needed and missing.
[[nodiscard]] Gyroscope load_gyroscope(const MotionModelOptions& options, const Dataset& dataset);

}  // namespace saccade
