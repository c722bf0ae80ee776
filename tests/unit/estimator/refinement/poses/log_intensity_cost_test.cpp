#include "estimator/refinement/poses/log_intensity_cost.h"

#include <gtest/gtest.h>

#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/refinement/poses/corner_view.h"

namespace saccade {
namespace {

using testing::corner_view;
using LevelUnknowns = Eigen::Matrix<double, 25, 1>;

/// A pixel that looks at the left wall, seen from a little way on.
LogIntensityCost::Observation some_observation(const MapSurface& surface) {
  const auto controls = SplineControls::smooth(corner_view().disturbed(1), 0.05);
  LogIntensityCost::Observation o;
  o.time = controls.knots.at(0.12);
  for (std::size_t k = 0; k < 4; ++k) o.controls[k] = controls.poses[o.time.first + k];
  o.ray = corner_view().world.camera().ray({40, 50});
  o.relative_log_intensity = -0.3;
  o.sigma = 0.06;
  o.hit.plane = *surface.plane(0, {44.3, 51.8});
  return o;
}

TEST(LogIntensityCost, HasItsDerivativesAlsoAwayFromZero) {
  const MapSurface surface(corner_view().map);
  const LogIntensityCost cost(some_observation(surface), surface);
  LevelUnknowns at;
  for (Eigen::Index i = 0; i < 25; ++i) at[i] = 0.004 * std::sin(1.7 * static_cast<double>(i));
  const auto evaluate = [&](const LevelUnknowns& x, double** jacobians) {
    const double* blocks[] = {&x[0], &x[6], &x[12], &x[18], &x[24]};
    Eigen::Matrix<double, 1, 1> residual;
    EXPECT_TRUE(cost.Evaluate(blocks, residual.data(), jacobians));
    return residual;
  };
  LevelUnknowns derivatives;
  double* jacobians[] = {&derivatives[0], &derivatives[6], &derivatives[12], &derivatives[18],
                         &derivatives[24]};
  evaluate(at, jacobians);
  testing::expect_jacobian<1, 25>(
      derivatives.transpose(), [&](const LevelUnknowns& x) { return evaluate(x, nullptr); }, at,
      1e-6, 1e-6);
}

TEST(LogIntensityCost, ARayThatLeavesThePlaneIsNoResidual) {
  const MapSurface surface(corner_view().map);
  LogIntensityCost::Observation o = some_observation(surface);
  o.hit.plane = -o.hit.plane;
  const LogIntensityCost cost(o, surface);
  const LevelUnknowns x = LevelUnknowns::Zero();
  const double* blocks[] = {&x[0], &x[6], &x[12], &x[18], &x[24]};
  double residual = 0;
  EXPECT_FALSE(cost.Evaluate(blocks, &residual, nullptr));
}

}  // namespace
}  // namespace saccade
