#pragma once

#include <span>

#include "core/camera.h"
#include "estimator/reconstruction/gradient_filter.h"
#include "estimator/reconstruction/image_estimator.h"

namespace saccade {

/// Writes gradients, covariances and the mask of what is observed (the standard deviation in the
/// surest direction is below `observed_sigma` [log units/px]) into `result`. One state per pixel.
void set_gradient(Reconstruction& result, const PinholeCamera& camera,
                  std::span<const GradientState> states, double observed_sigma);

}  // namespace saccade
