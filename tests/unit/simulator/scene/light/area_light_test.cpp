#include "simulator/scene/light/area_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "simulator/scene/light/illumination.h"
#include "simulator/scene/scene_builder.h"
#include "simulator/scene/scene_options.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using std::numbers::pi;

LightOptions area(LightType type, std::size_t samples_per_side) {
  LightOptions light;
  light.type = type;
  light.position = {0, 0, 1};
  light.direction = {0, 0, -1};
  light.size_m = {0.8, 0.5};
  light.width_direction = {1, 0, 0};
  light.radius_m = 0.4;
  light.intensity = 1;
  light.samples_per_side = samples_per_side;
  return light;
}

double irradiance(const LightOptions& light, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& normal) {
  const Illumination illumination(0, std::nullopt, emitters_of(light), 0);
  return illumination.irradiance({point, normal, normal, 0, 0}, ~LightSet{0});
}

/// Lambert's formula for the irradiance over pi that a polygon of radiance 1 makes on a surface that
/// all of it is above.
double irradiance_of_polygon(std::vector<Eigen::Vector3d> corners, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& normal) {
  double sum = 0;
  for (Eigen::Vector3d& corner : corners) corner -= point;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector3d& a = corners[k];
    const Eigen::Vector3d& b = corners[(k + 1) % corners.size()];
    const Eigen::Vector3d cross = a.cross(b);
    sum += std::atan2(cross.norm(), a.dot(b)) * normal.dot(cross.normalized());
  }
  return std::abs(sum) / (2 * pi);
}

/// Of the rectangle of area(), its part of x in [low, high]; its intensity is 1 in all.
double irradiance_of_rectangle(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               double low = -0.4, double high = 0.4) {
  const double radiance = pi / (0.8 * 0.5);
  return radiance *
         irradiance_of_polygon({{low, -0.25, 1}, {high, -0.25, 1}, {high, 0.25, 1}, {low, 0.25, 1}},
                               point, normal);
}

/// Greatest error over some points at a distance from a rectangle's plane, relative.
double rectangle_error(std::size_t samples_per_side, double distance) {
  const Eigen::Vector3d tilted = Eigen::Vector3d(0.2, -0.1, 1).normalized();
  double worst = 0;
  for (const double x : {0.0, 0.2, -0.5})
    for (const double y : {0.0, 0.3}) {
      const Eigen::Vector3d point(x, y, 1 - distance);
      const double truth = irradiance_of_rectangle(point, tilted);
      const double seen = irradiance(area(LightType::kRectangle, samples_per_side), point, tilted);
      worst = std::max(worst, std::abs(seen / truth - 1));
    }
  return worst;
}

TEST(AreaLight, RectangleIsTheContourFormula) {
  EXPECT_LT(rectangle_error(4, 2), 2e-4);
  EXPECT_LT(rectangle_error(4, 0.8), 3e-3);  // as far away as it is wide
  EXPECT_LT(rectangle_error(4, 0.4), 0.03);
  EXPECT_LT(rectangle_error(8, 0.8), 1.5e-3);
  for (const double distance : {0.25, 0.4, 0.8, 2.0}) {
    EXPECT_LT(rectangle_error(8, distance), rectangle_error(4, distance));
    EXPECT_LT(rectangle_error(4, distance), rectangle_error(2, distance));
    EXPECT_LT(rectangle_error(2, distance), rectangle_error(1, distance));
  }
}

TEST(AreaLight, DiscOnItsAxisIsTheClosedForm) {
  for (const double distance : {0.4, 0.8, 2.0}) {
    // E / pi = L R^2 / (R^2 + d^2) with intensity L R^2 = 1.
    const double truth = 1 / (0.16 + distance * distance);
    const Eigen::Vector3d point(0, 0, 1 - distance);
    const auto error = [&](std::size_t n) {
      return std::abs(irradiance(area(LightType::kDisc, n), point, {0, 0, 1}) / truth - 1);
    };
    EXPECT_LT(error(4), 1e-3) << distance;
    EXPECT_LT(error(8), 1e-4) << distance;
  }
}

TEST(AreaLight, ShinesFromOneFace) {
  for (const LightType type : {LightType::kRectangle, LightType::kDisc})
    EXPECT_EQ(irradiance(area(type, 4), {0, 0, 1.5}, {0, 0, -1}), 0);
}

TEST(AreaLight, PointsAreOneInEachRowAndColumnAndSymmetric) {
  for (std::size_t side = 1; side <= 8; ++side) {
    const std::size_t n = side * side;
    std::set<long> columns, rows;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const LightOptions& emitter : emitters_of(area(LightType::kRectangle, side))) {
      const Eigen::Vector3d p = emitter.position;
      columns.insert(std::lround(std::floor((p.x() + 0.4) / 0.8 * static_cast<double>(n))));
      rows.insert(std::lround(std::floor((p.y() + 0.25) / 0.5 * static_cast<double>(n))));
      mean += p / static_cast<double>(n);
    }
    EXPECT_EQ(columns.size(), n);
    EXPECT_EQ(rows.size(), n);
    EXPECT_LT((mean - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12) << n;
  }
}

TEST(AreaLight, WidthIsLevelUnlessItIsStated) {
  LightOptions light = area(LightType::kRectangle, 5);
  light.width_direction.setZero();
  light.direction = {1, 1, -1};
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  for (const LightOptions& emitter : emitters_of(light)) {
    const Eigen::Vector3d offset = emitter.position - light.position;
    EXPECT_NEAR(offset.dot(light.direction), 0, 1e-12);
    far = far.cwiseMax(offset.cwiseAbs());
  }
  EXPECT_LT(far.z(), 0.25);  // half the height, slanted
  EXPECT_GT(far.x(), 0.25);
}

/// A floor under the light, half covered by a sheet whose edge is at x = 0 and z = 0.5.
Scene penumbra_scene(const LightOptions& light) {
  SceneBuilder builder;
  builder.add(testing::rectangle({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  builder.add(testing::rectangle({0, -3, 0.5}, {3, 0, 0}, {0, 6, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  builder.light(0, {light});
  return std::move(builder).build(Background(0));
}

TEST(AreaLight, HalfShadowIsTheAnalyticOne) {
  for (const auto& [side, bound] : {std::pair<std::size_t, double>(4, 0.035), {8, 0.01}}) {
    const Scene scene = penumbra_scene(area(LightType::kRectangle, side));
    const double full = irradiance_of_rectangle({0, 0, 0}, {0, 0, 1});
    std::set<long> levels;
    for (double x = -0.6; x <= 0.6; x += 0.01) {
      // Through the sheet's edge, the point sees the light beyond -x.
      const double from = std::clamp(-x, -0.4, 0.4);
      const double truth =
          from > -0.4 ? irradiance_of_rectangle({x, 0, 0}, {0, 0, 1}, -0.4, from) : 0;
      const double seen = testing::see(scene, {{x - 0.3, 0, 0.3}, {0.3, 0, -0.3}}).radiance;
      EXPECT_NEAR(seen, truth, bound * full) << x;
      levels.insert(std::lround(1000 * seen / full));
    }
    EXPECT_GT(levels.size(), side * side);
  }
}

TEST(AreaLight, CountsEachEmitterAmongTheLightsOfAScene) {
  const auto read = [](const std::string& lights) {
    return config::read<SceneOptions>(config::parse(
        "lighting: lambertian\nmeshes: [{file: " __FILE__ "}]\nlights: [" + lights + "]",
        "scene.yaml"));
  };
  const std::string rectangle =
      "{type: rectangle, position: [0, 0, 1], direction: [0, 0, -1], size_m: [1, 2], "
      "samples_per_side: ";
  EXPECT_EQ(emitter_count(read(rectangle + "7}, {position: [0, 0, 1]}").lights), 50U);
  EXPECT_THROW(read(rectangle + "8}, {position: [0, 0, 1]}"), InputError);
  EXPECT_THROW(read(rectangle + "9}"), InputError);
  EXPECT_THROW(read(rectangle + "0}"), InputError);
  EXPECT_THROW(read("{type: rectangle, position: [0, 0, 1], direction: [0, 0, -1], "
                    "width_direction: [0, 0, 2]}"),
               InputError);
  EXPECT_THROW(read("{type: disc, position: [0, 0, 1], direction: [0, 0, 1], size_m: [1, 1]}"),
               InputError);
  EXPECT_THROW(read("{type: disc, position: [0, 0, 1], direction: [0, 0, 1], radius_m: 0}"),
               InputError);
}

}  // namespace
}  // namespace saccade
