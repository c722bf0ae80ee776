#include "simulator/sensor/signal/texel_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// A quartic with all terms, which the track must reproduce.
double value(double u) { return 3 + u * (7 + u * (-2 + u * (1.5 - 0.7 * u))); }
double slope(double u) { return 7 + u * (-4 + u * (4.5 - 2.8 * u)); }

TEST(TrajectoryCoordinate, IsTheQuarticOfItsEndsAndMiddle) {
  const TrajectoryCoordinate track(value(0), slope(0), value(0.5), slope(0.5), value(1), slope(1));
  for (double u = 0; u <= 1; u += 1.0 / 64) {
    EXPECT_NEAR(track.at(u), value(u), 1e-12);
    EXPECT_NEAR(track.slope_at(u), slope(u), 1e-12);
  }
}

TEST(TrajectoryCoordinate, SlopeIsTheDerivative) {
  const TrajectoryCoordinate track(1, 4, 3.5, 7, 6, -2);
  constexpr double kStep = 1e-6;
  for (double u = 0.01; u < 1; u += 0.07)
    EXPECT_NEAR(track.slope_at(u), (track.at(u + kStep) - track.at(u - kStep)) / (2 * kStep), 1e-7);
}

TEST(TrajectoryCoordinate, BendBoundsTheSecondDerivative) {
  const TrajectoryCoordinate track(1, 40, 3.5, -30, 6, 50);
  constexpr double kStep = 1e-4;
  double most = 0;
  for (double u = kStep; u < 1 - kStep; u += 1e-3)
    most = std::max(most,
                    std::abs(track.slope_at(u + kStep) - track.slope_at(u - kStep)) / (2 * kStep));
  EXPECT_LE(most, track.second_derivative_bound());
  EXPECT_GT(most, 0.1 * track.second_derivative_bound());
}

TEST(CoordinateBounds, BoundsValuesAndSlopes) {
  const TrajectoryCoordinate track(1, 40, 3.5, -30, 6, 50);
  for (const auto& [u0, u1] : {std::pair(0.0, 1.0), std::pair(0.1, 0.4), std::pair(0.7, 0.71)}) {
    const CoordinateBounds part(track, u0, u1);
    for (int k = 0; k <= 100; ++k) {
      const double u = u0 + (u1 - u0) * k / 100;
      EXPECT_GE(track.at(u), part.values.low - 1e-12);
      EXPECT_LE(track.at(u), part.values.high + 1e-12);
      EXPECT_GE(track.slope_at(u), part.slopes.low - 1e-12);
      EXPECT_LE(track.slope_at(u), part.slopes.high + 1e-12);
    }
  }
}

// Of a sine, 0.2 rad within the stretch: the estimate bounds the true error, but not by orders of
// magnitude.
TEST(TrajectoryCoordinate, KnowsItsError) {
  const auto position = [](double u) { return 1000 * std::sin(0.5 + 0.2 * u); };
  const auto rate = [](double u) { return 200 * std::cos(0.5 + 0.2 * u); };
  const TrajectoryCoordinate track(position(0), rate(0), position(0.5), rate(0.5), position(1),
                                   rate(1));
  double worst = 0;
  for (double u = 0; u <= 1; u += 1e-3)
    worst = std::max(worst, std::abs(track.at(u) - position(u)));
  EXPECT_TRUE(track.may_exceed(worst / 1.1));
  EXPECT_FALSE(track.may_exceed(worst / 0.05));
}

}  // namespace
}  // namespace saccade
