#pragma once

#include <cstddef>
#include <span>

#include "core/check.h"
#include "estimator/reconstruction/gradient/gradient_filter.h"
#include "estimator/reconstruction/image_solver.h"
#include "estimator/reconstruction/observations/reference_grid.h"

namespace saccade {

/// Writes gradients, covariances and the mask of observed pixels (the standard deviation of the
/// gradient in its best known direction is below half of the prior's) into `result`. One state per
/// pixel.
inline void set_gradient(Reconstruction& result, const ReferenceGrid& grid,
                         std::span<const GradientState> states) {
  for (ImageF* image : {&result.gradient_x, &result.gradient_y, &result.covariance_xx,
                        &result.covariance_xy, &result.covariance_yy})
    *image = ImageF(grid.width(), grid.height());
  result.observed = ImageU8(grid.width(), grid.height());
  SACCADE_CHECK(states.size() == result.observed.size());
  constexpr double kObservedSigma = kGradientPriorSigma / 2;
  const auto limit = static_cast<float>(kObservedSigma * kObservedSigma);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const GradientState& s = states[i];
    result.gradient_x.pixels()[i] = s.gx;
    result.gradient_y.pixels()[i] = s.gy;
    result.covariance_xx.pixels()[i] = s.pxx;
    result.covariance_xy.pixels()[i] = s.pxy;
    result.covariance_yy.pixels()[i] = s.pyy;
    result.observed.pixels()[i] = s.least_variance() < limit ? 1 : 0;
  }
}

}  // namespace saccade
