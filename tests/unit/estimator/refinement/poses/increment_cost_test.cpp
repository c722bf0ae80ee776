#include "estimator/refinement/poses/increment_cost.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/refinement/poses/corner_view.h"

namespace saccade {
namespace {

using testing::corner_view;

/// A pixel that looks at the left wall, over a window that begins at `begin_s` and ends at 0.12 s;
/// over knots of 0.05 s.
struct Window {
  explicit Window(double begin_s) {
    observation.ray = corner_view().world.camera().ray({40, 50});
    observation.begin = {path.knots.at(begin_s), {0, *surface.plane(0, {44.3, 51.8}), {}}};
    observation.end = {path.knots.at(0.12), {0, *surface.plane(0, {46.1, 52.4}), {}}};
    observation.increment = -0.2;
    observation.sigma = 0.1;
  }

  MapSurface surface{corner_view().map};
  SplineControls path = SplineControls::smooth(corner_view().disturbed(1), 0.05);
  IncrementCost::Observation observation;
};

template <int kControls>
void expect_derivatives(double begin_s) {
  constexpr int kUnknowns = kControls * kControlSize;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  const Window window(begin_s);
  const IncrementCost cost(window.observation, window.path.poses, window.surface);
  ASSERT_EQ(cost.blocks(), static_cast<std::size_t>(kControls));
  Unknowns at;
  for (Eigen::Index i = 0; i < kUnknowns; ++i)
    at[i] = 0.004 * std::sin(1.7 * static_cast<double>(i));
  const auto evaluate = [&](const Unknowns& x, double** jacobians) {
    std::array<const double*, kControls> blocks{};
    for (int k = 0; k < kControls; ++k)
      blocks[static_cast<std::size_t>(k)] = x.data() + kControlSize * k;
    Eigen::Matrix<double, 1, 1> residual;
    EXPECT_TRUE(cost.Evaluate(blocks.data(), residual.data(), jacobians));
    return residual;
  };
  Unknowns derivatives;
  std::array<double*, kControls> jacobians{};
  for (int k = 0; k < kControls; ++k)
    jacobians[static_cast<std::size_t>(k)] = derivatives.data() + kControlSize * k;
  evaluate(at, jacobians.data());
  testing::expect_jacobian<1, kUnknowns>(
      derivatives.transpose(), [&](const Unknowns& x) { return evaluate(x, nullptr); }, at, 1e-6,
      1e-6);
}

TEST(IncrementCost, HasItsDerivativesWithinASegment) { expect_derivatives<4>(0.11); }

TEST(IncrementCost, HasItsDerivativesOverAKnot) { expect_derivatives<5>(0.09); }

TEST(IncrementCost, HasItsDerivativesOverSegmentsBetween) { expect_derivatives<6>(0.03); }

TEST(IncrementCost, IsTheDifferenceOfWhatIsSeenAtBothEnds) {
  Window window(0.11);
  const std::array<double, kControlSize> none{};
  const std::array<const double*, 4> blocks = {none.data(), none.data(), none.data(), none.data()};
  const auto residual = [&] {
    const IncrementCost cost(window.observation, window.path.poses, window.surface);
    double value = 0;
    EXPECT_TRUE(cost.Evaluate(blocks.data(), &value, nullptr));
    return value;
  };
  const auto level = [&](const IncrementCost::Instant& instant) {
    const std::span controls = std::span(window.path.poses).subspan(instant.time.first, 4);
    return sample_log_intensity(window.surface, instant.hit, window.observation.ray, instant.time,
                                controls, blocks.data())
        .value;
  };
  const double increment = level(window.observation.end) - level(window.observation.begin);
  EXPECT_GT(std::abs(increment), 1e-3);
  EXPECT_NEAR(residual(), (increment + 0.2) / 0.1, 1e-9);
  window.observation.increment = increment;
  EXPECT_NEAR(residual(), 0, 1e-9);
}

TEST(IncrementCost, ARayThatLeavesAPlaneIsNoResidual) {
  Window window(0.11);
  window.observation.begin.hit.plane *= -1;
  const IncrementCost cost(window.observation, window.path.poses, window.surface);
  const std::array<double, kControlSize> none{};
  const std::array<const double*, 4> blocks = {none.data(), none.data(), none.data(), none.data()};
  double residual = 0;
  EXPECT_FALSE(cost.Evaluate(blocks.data(), &residual, nullptr));
}

}  // namespace
}  // namespace saccade
