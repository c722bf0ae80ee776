#include "simulator/sensor/signal/texel_traversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/meshes.h"

namespace saccade {
namespace {

PlaneTrack track(double from, double from_slope, double middle, double middle_slope, double to,
                 double to_slope) {
  return {from, from_slope, middle, middle_slope, to, to_slope};
}

/// Curved, and in y with a turn.
PlanePath bent_path() {
  return {track(3.2, 8.8, 7.5, 8.4, 11.6, 8), track(5.3, -4, 4.3, 0.1, 5.4, 4.2), 2.0, 0.01};
}

TEST(Borders, AreWhereTheTrackCrossesTexels) {
  const PlaneTrack curved = track(3.2, 8.8, 7.5, 8.4, 11.6, 8);
  const Borders borders(curved);
  ASSERT_TRUE(borders.is_steady());
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(borders.index(k), 3 + k);
    EXPECT_NEAR(curved.at(borders.crossing(k)), 4 + k, 1e-4) << k;
  }
  EXPECT_EQ(borders.crossing(8), 1);
  EXPECT_EQ(borders.passed(0), 0);
  EXPECT_EQ(borders.passed(1), 8);
}

TEST(Borders, GoBackwards) {
  const PlaneTrack back = track(3.2, -2.2, 2.09, -2.3, 0.9, -2.5);
  const Borders borders(back);
  ASSERT_TRUE(borders.is_steady());
  EXPECT_EQ(borders.index(0), 3);
  EXPECT_NEAR(back.at(borders.crossing(0)), 3, 1e-4);
  EXPECT_EQ(borders.index(3), 0);
}

TEST(Borders, AreNotSteadyAcrossATurn) {
  EXPECT_FALSE(Borders(track(5.3, -4, 4.3, 0.1, 5.4, 4.2)).is_steady());
  EXPECT_TRUE(Borders(track(5.3, -0.1, 5.29, 0, 5.3, 0.1)).is_steady());
}

// Every time at which the texture is outside the band lies in a part that is looked at.
TEST(CellWalk, MeetsAllThatLeavesTheBand) {
  const Texture texture(testing::patches(16, 12, 5));
  const PlanePath path = bent_path();
  for (const Interval& band : {Interval{0.22, 0.5}, Interval{0.15, 0.24}, Interval{0.2, 0.3}}) {
    std::vector<std::pair<double, double>> met;
    const CellWalk walk(texture, path);
    const bool went_through = walk.go(
        0, 1, band,
        [&](const CellCourse& course, const CellCourse::Shape&) {
          met.emplace_back(course.from(), course.to());
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

TEST(CellCourse, HasTheValuesAndSlopesOfTheTexture) {
  const Texture texture(testing::patches(16, 12, 5));
  const PlanePath path = bent_path();
  const CellWalk walk(texture, path);
  const Interval nowhere{2, 3};
  int cells = 0;
  walk.go(
      0, 1, nowhere,
      [&](const CellCourse& course, const CellCourse::Shape& shape) {
        ++cells;
        const double u = 0.5 * (course.from() + course.to());
        EXPECT_NEAR(course.value(u), texture.at_texel(path.x.at(u), path.y.at(u)), 2e-4);
        constexpr double kStep = 1e-6;
        EXPECT_NEAR(course.slope(u),
                    (course.value(u + kStep) - course.value(u - kStep)) / (2 * kStep), 1e-5);
        for (double f = 0; f <= 1; f += 0.1) {
          const double value = course.value(course.from() + f * (course.to() - course.from()));
          EXPECT_GE(value, shape.values.low);
          EXPECT_LE(value, shape.values.high);
        }
        return true;
      },
      [](double, double) { return true; });
  EXPECT_GT(cells, 8);
}

}  // namespace
}  // namespace saccade
