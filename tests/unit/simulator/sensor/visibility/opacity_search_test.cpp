#include "simulator/sensor/visibility/opacity_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

/// Opaque but for |t - 0.43| < `half_s`, with a parabola of that width.
std::vector<OpacityInterval> around_a_hole(double half_s, double sign = 1) {
  const auto opacity = [&](double t_s) {
    return 0.5 + sign * (std::pow(t_s - 0.43, 2) - half_s * half_s);
  };
  return OpacitySearch(opacity, {0, opacity(0)}, {1, opacity(1)}, 8).intervals();
}

TEST(OpacitySearch, DividesTheWholeTime) {
  const auto ramp = [](double t_s) { return t_s + 0.2; };
  const auto found = OpacitySearch(ramp, {0, ramp(0)}, {1, ramp(1)}, 4).intervals();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FALSE(found[0].is_opaque);
  EXPECT_TRUE(found[1].is_opaque);
  EXPECT_EQ(found[0].from_s, 0);
  EXPECT_NEAR(found[0].to_s, 0.3, 1e-12);
  EXPECT_EQ(found[1].from_s, found[0].to_s);
  EXPECT_EQ(found[1].to_s, 1);
}

TEST(OpacitySearch, FindsHolesAndSpecksFarShorterThanAStep) {
  for (const double sign : {1.0, -1.0})
    for (const double half_s : {0.2, 0.05, 0.01, 1e-3, 1e-4}) {
      const auto found = around_a_hole(half_s, sign);
      ASSERT_EQ(found.size(), 3U) << half_s;
      EXPECT_EQ(found[0].is_opaque, sign > 0);
      EXPECT_EQ(found[1].is_opaque, sign < 0);
      EXPECT_GT(found[1].from_s, 0.43 - 1.1 * half_s);
      EXPECT_LT(found[1].to_s, 0.43 + 1.1 * half_s);
      EXPECT_LT(found[1].from_s, found[1].to_s);
    }
}

TEST(OpacitySearch, FindsAHoleWithAnEdgeAsAtTheBorderOfTexels) {
  const auto opacity = [](double t_s) { return 0.4999 + std::abs(t_s - 0.071); };
  EXPECT_EQ(OpacitySearch(opacity, {0, opacity(0)}, {1, opacity(1)}, 4).intervals().size(), 3U);
}

TEST(OpacitySearch, FindsNothingWhereAnExtremumStaysAway) {
  const auto opacity = [](double t_s) { return 0.5001 + std::pow(t_s - 0.43, 2); };
  const auto found = OpacitySearch(opacity, {0, opacity(0)}, {1, opacity(1)}, 8).intervals();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].is_opaque);
  EXPECT_EQ(found[0].to_s, 1);
}

}  // namespace
}  // namespace saccade
