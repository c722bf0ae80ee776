#pragma once

#include <span>

#include "estimator/reconstruction/gradient_filter.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

/// Writes gradients, covariances and the mask of what is observed (the standard deviation in the
/// surest direction is below `observed_sigma` [log units/px]) into `result`. One state per pixel.
void set_gradient(Reconstruction& result, const ReferenceGrid& grid,
                  std::span<const GradientState> states, double observed_sigma);

}  // namespace saccade
