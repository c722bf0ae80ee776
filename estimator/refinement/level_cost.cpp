#include "estimator/refinement/level_cost.h"

#include "estimator/refinement/jacobian_block.h"

namespace saccade {

bool LevelCost::Evaluate(double const* const* parameters, double* residuals,
                         double** jacobians) const {
  const Observation& o = observation_;
  const SeenLevel seen = seen_level(surface_, o.hit, o.ray, o.time, o.controls, parameters);
  if (!seen.is_valid) return false;
  residuals[0] = (seen.value - o.level - parameters[4][0]) / o.sigma;
  if (jacobians == nullptr) return true;
  for (int k = 0; k < 4; ++k)
    write_block(jacobians[k],
                (seen.by_controls.segment<kControlSize>(kControlSize * k) / o.sigma).eval());
  if (jacobians[4] != nullptr) jacobians[4][0] = -1 / o.sigma;
  return true;
}

}  // namespace saccade
