#include "simulator/scene/light/spot_cone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace saccade {
namespace {

using std::numbers::pi;

LightOptions spot(double inner_deg, double outer_deg) {
  LightOptions light;
  light.type = LightType::kSpot;
  light.position = {1, 2, 3};
  light.direction = Eigen::Vector3d(0, 0.6, -0.8);
  light.inner_angle_deg = inner_deg;
  light.outer_angle_deg = outer_deg;
  return light;
}

/// At an angle off the axis and a distance.
Eigen::Vector3d point_at(const LightOptions& light, double angle_deg, double distance) {
  const Eigen::Vector3d side = light.direction.unitOrthogonal();
  const double angle = angle_deg * pi / 180;
  return light.position + distance * (std::cos(angle) * light.direction + std::sin(angle) * side);
}

TEST(SpotCone, FallsOffByTheClosedForm) {
  const LightOptions light = spot(20, 40);
  const SpotCone cone(light);
  const auto cosine = [](double deg) { return std::cos(deg * pi / 180); };
  for (const double distance : {0.01, 1.0, 70.0}) {
    for (const double angle : {0.0, 7.0, 19.99})
      EXPECT_EQ(cone.falloff(point_at(light, angle, distance)), 1) << angle;
    for (const double angle : {21.0, 30.0, 39.0}) {
      const double part = (cosine(angle) - cosine(40)) / (cosine(20) - cosine(40));
      EXPECT_NEAR(cone.falloff(point_at(light, angle, distance)), part * part, 1e-12) << angle;
    }
    for (const double angle : {40.01, 90.0, 180.0})
      EXPECT_EQ(cone.falloff(point_at(light, angle, distance)), 0) << angle;
  }
}

TEST(SpotCone, CanBeAlmostSharpAndAHalfSpace) {
  const LightOptions sharp = spot(30, 30 + kLeastFalloff_deg);
  EXPECT_EQ(SpotCone(sharp).falloff(point_at(sharp, 29.999, 2)), 1);
  EXPECT_EQ(SpotCone(sharp).falloff(point_at(sharp, 30.011, 2)), 0);
  const LightOptions half = spot(0, 90);
  EXPECT_NEAR(SpotCone(half).falloff(point_at(half, 60, 2)), 0.25, 1e-12);
  EXPECT_EQ(SpotCone(half).falloff(point_at(half, 91, 2)), 0);
}

TEST(SpotCone, MissesSpheresOutsideOfIt) {
  const LightOptions light = spot(10, 30);
  const SpotCone cone(light);
  const double radius = 2 * std::sin(5 * pi / 180);  // of 5 degrees at a distance of 2
  EXPECT_TRUE(cone.misses(point_at(light, 35.01, 2), radius));
  EXPECT_FALSE(cone.misses(point_at(light, 34.99, 2), radius));
  EXPECT_TRUE(cone.misses(point_at(light, 180, 2), radius));
  EXPECT_FALSE(cone.misses(point_at(light, 0, 2), radius));
  EXPECT_FALSE(cone.misses(point_at(light, 180, 2), 2.1)) << "the light is inside of it";
}

/// A curved way of a point: a line, a bend and a small cubic part.
struct Way {
  Eigen::Vector3d start, speed, bend, twist;

  [[nodiscard]] Eigen::Vector3d at(double s) const {
    return start + s * speed + s * (s - 1) * bend + s * (s - 0.5) * (s - 1) * twist;
  }
};

Way random_way(std::mt19937& generator, const LightOptions& light) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto vector = [&] {
    return Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
  };
  const double reach = std::pow(10, -3 * uniform(generator));
  Way way;
  // Half of them around the edge of the cone, where it changes most.
  const double angle = uniform(generator) < 0.5 ? light.outer_angle_deg : 90 * uniform(generator);
  way.start = point_at(light, angle, 0.5 + 4 * uniform(generator)) + 0.1 * reach * vector();
  way.speed = reach * vector();
  way.bend = 0.3 * reach * uniform(generator) * vector();
  way.twist = 0.003 * reach * vector();
  return way;
}

TEST(SpotCone, BoundsContainWhatLiesAlongAWay) {
  constexpr double kLength_s = 0.01;
  constexpr int kSamples = 400;
  std::mt19937 generator(3);
  for (const auto& [inner, outer] :
       {std::pair{0.0, 45.0}, {20.0, 22.0}, {30.0, 30.1}, {5.0, 90.0}}) {
    const LightOptions light = spot(inner, outer);
    const SpotCone cone(light);
    int proven = 0;
    for (int n = 0; n < 1500; ++n) {
      const Way way = random_way(generator, light);
      const LightRange range = cone.falloff_range(way.at(0), way.at(0.5), way.at(1), kLength_s);
      double low = 1, high = 0, slowest = std::numeric_limits<double>::infinity();
      double fastest = -slowest, last = 0;
      for (int k = 0; k <= kSamples; ++k) {
        const double value = cone.falloff(way.at(static_cast<double>(k) / kSamples));
        low = std::min(low, value);
        high = std::max(high, value);
        if (k > 0) {
          slowest = std::min(slowest, (value - last) * kSamples / kLength_s);
          fastest = std::max(fastest, (value - last) * kSamples / kLength_s);
        }
        last = value;
      }
      ASSERT_LE(range.low, low + 1e-9) << inner << " " << outer << " " << n;
      ASSERT_GE(range.high, high - 1e-9) << inner << " " << outer << " " << n;
      ASSERT_LE(range.rate_low, slowest + 1e-6) << inner << " " << outer << " " << n;
      ASSERT_GE(range.rate_high, fastest - 1e-6) << inner << " " << outer << " " << n;
      ASSERT_GE(range.low, 0);
      ASSERT_LE(range.high, 1);
      if (range.rate_low >= 0 || range.rate_high <= 0) ++proven;
    }
    EXPECT_GT(proven, 700) << "are monotone for certain";
  }
}

TEST(SpotCone, BoundsBecomeNarrowOverShortWays) {
  const LightOptions light = spot(10, 30);
  const SpotCone cone(light);
  const Eigen::Vector3d from = point_at(light, 20, 2);
  const Eigen::Vector3d to = point_at(light, 20.01, 2);
  const LightRange range = cone.falloff_range(from, 0.5 * (from + to), to, 1);
  const double change = cone.falloff(to) - cone.falloff(from);
  EXPECT_NEAR(range.low, cone.falloff(to), 0.01 * std::abs(change));
  EXPECT_NEAR(range.high, cone.falloff(from), 0.01 * std::abs(change));
  EXPECT_NEAR(range.rate_low / change, 1, 0.05);
  EXPECT_NEAR(range.rate_high / change, 1, 0.05);
}

TEST(SpotCone, BoundsOfAPointAtRestAreItsFalloff) {
  const LightOptions light = spot(10, 30);
  const SpotCone cone(light);
  for (const double angle : {5.0, 20.0, 30.0, 50.0}) {
    const Eigen::Vector3d point = point_at(light, angle, 2);
    const LightRange range = cone.falloff_range(point, point, point, 1);
    EXPECT_NEAR(range.low, cone.falloff(point), 1e-12);
    EXPECT_NEAR(range.high, cone.falloff(point), 1e-12);
    EXPECT_EQ(range.rate_low, 0);
    EXPECT_EQ(range.rate_high, 0);
  }
}

TEST(SpotCone, NothingIsKnownOfWaysAroundTheLight) {
  const LightOptions light = spot(10, 30);
  const Eigen::Vector3d side = light.direction.unitOrthogonal();
  const LightRange range = SpotCone(light).falloff_range(light.position - side, light.position,
                                                         light.position + side, 1);
  EXPECT_EQ(range.low, 0);
  EXPECT_EQ(range.high, 1);
  EXPECT_EQ(range.rate_high, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace saccade
