#include "estimator/refinement/poses/log_intensity_cost.h"

#include "estimator/edges/least_squares/jacobian_block.h"

namespace saccade {

bool LogIntensityCost::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const Observation& o = observation_;
  const LogIntensitySample seen =
      sample_log_intensity(surface_, o.hit, o.ray, o.time, o.controls, parameters);
  if (!seen.is_valid) return false;
  residuals[0] = (seen.value - o.relative_log_intensity - parameters[4][0]) / o.sigma;
  if (jacobians == nullptr) return true;
  for (int k = 0; k < 4; ++k)
    write_block(jacobians[k],
                (seen.by_controls.segment<kControlSize>(kControlSize * k) / o.sigma).eval());
  if (jacobians[4] != nullptr) jacobians[4][0] = -1 / o.sigma;
  return true;
}

}  // namespace saccade
