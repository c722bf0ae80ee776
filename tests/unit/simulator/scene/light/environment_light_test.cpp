#include "simulator/scene/light/environment_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "simulator/scene/background.h"
#include "simulator/scene/scene_builder.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using std::numbers::pi;
using RadianceOf = std::function<double(const Eigen::Vector3d&)>;

/// The direction in which texel (i, j) of a map is seen.
Eigen::Vector3d direction_of(int i, int j, int width, int height) {
  const double azimuth = pi - 2 * pi * (i + 0.5) / width;
  const double elevation = pi / 2 - pi * (j + 0.5) / height;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

ImageF map_of(const RadianceOf& radiance, int width = 256, int height = 128) {
  ImageF map(width, height);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      map(i, j) = static_cast<float>(radiance(direction_of(i, j, width, height)));
  return map;
}

std::vector<Eigen::Vector3d> some_normals() {
  std::vector<Eigen::Vector3d> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 40; ++k)
    normals.push_back(Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
  return normals;
}

/// The integral over a map's texels, over pi.
double integral(const ImageF& map, const Eigen::Vector3d& normal) {
  double sum = 0;
  for (int j = 0; j < map.height(); ++j) {
    const double top = pi / 2 - pi * j / map.height();
    const double solid_angle =
        2 * pi / map.width() * (std::sin(top) - std::sin(top - pi / map.height()));
    for (int i = 0; i < map.width(); ++i)
      sum += static_cast<double>(map(i, j)) * solid_angle *
             std::max(0.0, normal.dot(direction_of(i, j, map.width(), map.height())));
  }
  return sum / pi;
}

TEST(EnvironmentLight, UniformLightFallsAlikeOnEveryNormal) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 1), std::pair(64, 32)}) {
    const EnvironmentLight light(ImageF(width, height, 0.7F), 33, 2);
    for (const Eigen::Vector3d& normal : some_normals())
      EXPECT_NEAR(light.radiance(normal), 2 * 0.7, 1e-6) << width;
  }
  EXPECT_EQ(EnvironmentLight(0.7).radiance({0, 0.6, 0.8}), 0.7);
}

TEST(EnvironmentLight, IsExactForLobesOfSecondOrder) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const ImageF first = map_of([&](const auto& w) { return 1 + w.dot(axis); });
  const ImageF second = map_of([&](const auto& w) { return std::pow(w.dot(axis), 2); });
  const EnvironmentLight first_light(first, 0, 1);
  const EnvironmentLight second_light(second, 0, 1);
  for (const Eigen::Vector3d& normal : some_normals()) {
    const double x = normal.dot(axis);
    // The cosine's factors of order 0, 1 and 2 are 1, 2/3 and 1/4.
    EXPECT_NEAR(first_light.radiance(normal), 1 + 2.0 / 3 * x, 2e-4);
    EXPECT_NEAR(second_light.radiance(normal), 1.0 / 3 + 0.25 * (x * x - 1.0 / 3), 2e-4);
  }
}

TEST(EnvironmentLight, ErrsAsStated) {
  // All light from one direction, as much as gives a surface that faces it 1.
  const Eigen::Vector3d axis = direction_of(200, 40, 512, 256);
  ImageF sun(512, 256);
  sun(200, 40) = 1;
  const double scale = 1 / integral(sun, axis);
  const EnvironmentLight light(sun, 0, scale);
  double worst = 0;
  for (double angle = 0; angle <= pi; angle += 0.01) {
    const Eigen::Vector3d normal = std::cos(angle) * axis + std::sin(angle) * axis.unitOrthogonal();
    worst = std::max(worst, std::abs(light.radiance(normal) - std::max(0.0, std::cos(angle))));
  }
  EXPECT_NEAR(light.radiance(axis), 1.0625, 1e-3);
  EXPECT_LT(worst, 0.0945);
  EXPECT_GT(worst, 0.09);
  // A sky above a dark ground.
  const ImageF sky = map_of([](const auto& w) { return w.z() > 0 ? 1 + 2 * w.z() : 0.2; });
  const EnvironmentLight sky_light(sky, 0, 1);
  for (const Eigen::Vector3d& normal : some_normals())
    EXPECT_NEAR(sky_light.radiance(normal), integral(sky, normal), 0.03);
}

TEST(EnvironmentLight, TurnsWithTheBackground) {
  const RadianceOf lobe = [](const auto& w) { return 1.5 + w.x() + 0.3 * w.z() * w.y(); };
  const double yaw_deg = 70;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(yaw_deg * pi / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const EnvironmentLight straight(map_of(lobe), 0, 1);
  const EnvironmentLight turned(map_of(lobe), yaw_deg, 1);
  const Background background(map_of(lobe), yaw_deg);
  for (const Eigen::Vector3d& normal : some_normals()) {
    EXPECT_NEAR(turned.radiance(turn * normal), straight.radiance(normal), 1e-9);
    if (std::abs(normal.z()) < 0.9) {
      EXPECT_NEAR(background.sample(turn * normal).radiance(), lobe(normal), 1e-3);
    }
  }
}

TEST(EnvironmentLight, IsNeverNegative) {
  ImageF sun(64, 32);
  sun(10, 3) = 1000;
  const EnvironmentLight light(sun, 0, 1);
  for (const Eigen::Vector3d& normal : some_normals()) EXPECT_GE(light.radiance(normal), 0);
}

TEST(EnvironmentLight, AddsToAmbientLightOnWhatIsSeen) {
  SceneBuilder builder;
  builder.add(testing::rectangle({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, ImageF(2, 2, 0.5F)),
              Eigen::Affine3d::Identity());
  builder.light(0.25, {});
  builder.light_from_around(
      EnvironmentLight(map_of([](const auto& w) { return 1 - w.z(); }), 0, 1));
  const Scene scene = std::move(builder).build(Background(0));
  EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, {0, 0, 1}}).radiance, 0.5 * (0.25 + 1 + 2.0 / 3),
              1e-3);
}

}  // namespace
}  // namespace saccade
