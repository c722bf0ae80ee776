#pragma once

#include <span>

#include "estimator/reconstruction/gradient/gradient_filter.h"
#include "estimator/reconstruction/image_solver.h"
#include "estimator/reconstruction/observations/reference_grid.h"

namespace saccade {

/// Writes gradients, covariances and the mask of observed pixels (the standard deviation of the
/// gradient in its best known direction is below half of the prior's) into `result`. One state per
/// pixel.
void set_gradient(Reconstruction& result, const ReferenceGrid& grid,
                  std::span<const GradientState> states);

}  // namespace saccade
