#include "simulator/sensor/signal/texel_traversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/meshes.h"

namespace saccade {
namespace {

TrajectoryCoordinate track(double from, double from_slope, double middle, double middle_slope,
                           double to, double to_slope) {
  return {from, from_slope, middle, middle_slope, to, to_slope};
}

/// Curved, and in y with a turn.
TexelTrajectory bent_path() {
  return {track(3.2, 8.8, 7.5, 8.4, 11.6, 8), track(5.3, -4, 4.3, 0.1, 5.4, 4.2), 2.0, 0.01};
}

TEST(TexelBorders, AreWhereTheTrackCrossesTexels) {
  const TrajectoryCoordinate curved = track(3.2, 8.8, 7.5, 8.4, 11.6, 8);
  const TexelBorders borders(curved);
  ASSERT_TRUE(borders.is_monotone());
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(borders.index(k), 3 + k);
    EXPECT_NEAR(curved.at(borders.crossing(k)), 4 + k, 1e-4) << k;
  }
  EXPECT_EQ(borders.crossing(8), 1);
  EXPECT_EQ(borders.passed(0), 0);
  EXPECT_EQ(borders.passed(1), 8);
}

TEST(TexelBorders, GoBackwards) {
  const TrajectoryCoordinate back = track(3.2, -2.2, 2.09, -2.3, 0.9, -2.5);
  const TexelBorders borders(back);
  ASSERT_TRUE(borders.is_monotone());
  EXPECT_EQ(borders.index(0), 3);
  EXPECT_NEAR(back.at(borders.crossing(0)), 3, 1e-4);
  EXPECT_EQ(borders.index(3), 0);
}

TEST(TexelBorders, AreNotMonotoneAcrossATurningPoint) {
  EXPECT_FALSE(TexelBorders(track(5.3, -4, 4.3, 0.1, 5.4, 4.2)).is_monotone());
  EXPECT_TRUE(TexelBorders(track(5.3, -0.1, 5.29, 0, 5.3, 0.1)).is_monotone());
}

// Every time at which the texture is outside the band lies in a part that is seen.
TEST(TexelTraversal, MeetsAllThatLeavesTheBand) {
  const Texture texture(testing::patches(16, 12, 5));
  const TexelTrajectory path = bent_path();
  for (const Interval& band : {Interval{0.22, 0.5}, Interval{0.15, 0.24}, Interval{0.2, 0.3}}) {
    std::vector<std::pair<double, double>> met;
    const TexelTraversal walk(texture, path);
    const bool went_through = walk.traverse(
        0, 1, band,
        [&](const CellSegment& segment, const CellSegment::Bounds&) {
          met.emplace_back(segment.from(), segment.to());
          return true;
        },
        [&](double u0, double u1) {
          met.emplace_back(u0, u1);
          return true;
        });
    EXPECT_TRUE(went_through);
    int outside = 0;
    for (int k = 0; k <= 20000; ++k) {
      const double u = k / 20000.0;
      const double value = texture.at_texel(path.x.at(u), path.y.at(u));
      if (value > band.low && value < band.high) continue;
      ++outside;
      EXPECT_TRUE(std::any_of(met.begin(), met.end(), [&](const auto& part) {
        return u >= part.first - 1e-6 && u <= part.second + 1e-6;
      })) << u;
    }
    EXPECT_GT(outside, 100);
    // Not simply everything.
    double length = 0;
    for (const auto& [u0, u1] : met) length += u1 - u0;
    EXPECT_LT(length, 0.98);
  }
}

TEST(CellSegment, HasTheValuesAndSlopesOfTheTexture) {
  const Texture texture(testing::patches(16, 12, 5));
  const TexelTrajectory path = bent_path();
  const TexelTraversal walk(texture, path);
  const Interval nowhere{2, 3};
  int cells = 0;
  walk.traverse(
      0, 1, nowhere,
      [&](const CellSegment& segment, const CellSegment::Bounds& bounds) {
        ++cells;
        const double u = 0.5 * (segment.from() + segment.to());
        EXPECT_NEAR(segment.value(u), texture.at_texel(path.x.at(u), path.y.at(u)), 2e-4);
        constexpr double kStep = 1e-6;
        EXPECT_NEAR(segment.slope(u),
                    (segment.value(u + kStep) - segment.value(u - kStep)) / (2 * kStep), 1e-5);
        for (double f = 0; f <= 1; f += 0.1) {
          const double value = segment.value(segment.from() + f * (segment.to() - segment.from()));
          EXPECT_GE(value, bounds.values.low);
          EXPECT_LE(value, bounds.values.high);
        }
        return true;
      },
      [](double, double) { return true; });
  EXPECT_GT(cells, 8);
}

}  // namespace
}  // namespace saccade
