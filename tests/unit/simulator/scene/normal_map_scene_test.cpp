// Light on surfaces with normal maps.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/texture/normal_texture.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

/// Of random vectors that lean by up to `lean`, not of unit length.
std::shared_ptr<const NormalTexture> random_map(int width, int height, double lean,
                                                unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> part(static_cast<float>(-lean), static_cast<float>(lean));
  std::array<ImageF, 3> parts;
  for (ImageF& image : parts) image = ImageF(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      parts[0](x, y) = part(random);
      parts[1](x, y) = part(random);
    }
  return std::make_shared<const NormalTexture>(std::move(parts), WrapModes{});
}

Mesh mapped(Mesh mesh, std::shared_ptr<const NormalTexture> map) {
  mesh.materials[0].normal_map = std::move(map);
  mesh.normal_uvs = mesh.uvs;
  return mesh;
}

LightOptions sun(const Eigen::Vector3d& direction) {
  LightOptions light;
  light.type = LightType::kDirectional;
  light.direction = direction;
  light.intensity = 2;
  return light;
}

Scene lit(const Mesh& mesh, const std::vector<LightOptions>& lights, double ambient = 0,
          const Eigen::Affine3d& world_from_mesh = Eigen::Affine3d::Identity()) {
  SceneBuilder builder;
  builder.add(mesh, world_from_mesh);
  builder.light(ambient, lights);
  return std::move(builder).build(Background(0));
}

/// The square |x|, |y| <= 1 at z = 2, which faces the origin, with u along -x and v along -y.
Mesh square(std::shared_ptr<const NormalTexture> map) {
  return mapped(testing::rectangle({1, -1, 2}, {-2, 0, 0}, {0, 2, 0}, ImageF(2, 2, 0.5F)),
                std::move(map));
}

/// The centre of texel (i, j) of a map on that square.
Eigen::Vector3d texel_centre(const NormalTexture& map, int i, int j) {
  return {1 - 2 * (i + 0.5) / map.width(), -1 + 2 * (j + 0.5) / map.height(), 2};
}

TEST(NormalMapScene, ShadesByTheClosedForm) {
  const auto map = random_map(7, 5, 1.2);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const Scene scene = lit(square(map), {sun(direction)});
  for (int j = 0; j < map->height(); ++j)
    for (int i = 0; i < map->width(); ++i) {
      const Eigen::Vector3d v = map->at_texel(i, j, 0);
      const Eigen::Vector3d normal = Eigen::Vector3d(-v.x(), -v.y(), -v.z()).normalized();
      const double expected = 0.5 * 2 * std::max(0.0, -normal.dot(direction));
      EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, texel_centre(*map, i, j)}).radiance, expected,
                  1e-6);
    }
}

TEST(NormalMapScene, IsTurnedOverOnTheBack) {
  const auto map = random_map(4, 4, 0.8);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.2, -1).normalized();
  const Scene scene = lit(square(map), {sun(direction)});
  const Eigen::Vector3d at = texel_centre(*map, 1, 2);
  const Eigen::Vector3d behind(0.1, 0, 4);
  const Eigen::Vector3d normal = map->at_texel(1, 2, 0).normalized();  // of the back
  EXPECT_NEAR(testing::see(scene, {behind, at - behind}).radiance, -normal.dot(direction), 1e-6);
}

TEST(NormalMapScene, MovesWithItsMesh) {
  const auto map = random_map(5, 5, 0.7);
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 0.5).normalized()));
  pose.pretranslate(Eigen::Vector3d(0.2, -0.1, 0.4));
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const Scene scene = lit(square(map), {sun(direction)});
  const Scene turned = lit(square(map), {sun(pose.linear() * direction)}, 0, pose);
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(0.13, 0.4, 2), Eigen::Vector3d(-0.5, -0.77, 2)}) {
    const Ray ray{{0, 0, 0}, at};
    const Ray turned_ray{pose.translation(), pose.linear() * at};
    EXPECT_NEAR(testing::see(turned, turned_ray).radiance, testing::see(scene, ray).radiance, 1e-6);
  }
  // Mirrored, the picture is, too: its hollows stay hollows.
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear()(0, 0) = -1;
  const Scene mirrored = lit(square(map), {sun(mirror.linear() * direction)}, 0, mirror);
  EXPECT_NEAR(testing::see(mirrored, {{0, 0, 0}, {-0.13, 0.4, 2}}).radiance,
              testing::see(scene, {{0, 0, 0}, {0.13, 0.4, 2}}).radiance, 1e-6);
}

TEST(NormalMapScene, IsFlatUnderAFlatMapAndInAmbientLight) {
  std::array<ImageF, 3> parts{ImageF(2, 2, 0), ImageF(2, 2, 0), ImageF(2, 2, 1)};
  const auto flat = std::make_shared<const NormalTexture>(std::move(parts), WrapModes{});
  const Mesh ball = testing::ball({0, 0, 3}, 1, 12, ImageF(2, 2, 0.5F));
  const LightOptions light = sun({0.2, 0.3, 1});
  const Scene plain = lit(ball, {light}, 0.1);
  const Scene with_flat = lit(mapped(ball, flat), {light}, 0.1);
  const Scene ambient = lit(mapped(ball, random_map(8, 8, 1)), {}, 0.3);
  for (const double x : {-0.6, -0.2, 0.0, 0.4})
    for (const double y : {-0.5, 0.1, 0.6}) {
      const Ray ray{{0, 0, 0}, {x / 3, y / 3, 1}};
      EXPECT_NEAR(testing::see(with_flat, ray).radiance, testing::see(plain, ray).radiance, 1e-6);
      EXPECT_NEAR(testing::see(ambient, ray).radiance, 0.15, 1e-6);
      EXPECT_EQ(plain.normal(ray, testing::look(plain, ray)),
                ambient.normal(ray, testing::look(ambient, ray)));
    }
  EXPECT_FALSE(plain.has_normal_maps());
  EXPECT_TRUE(ambient.has_normal_maps());
}

TEST(NormalMapScene, FilteredAwayItIsItsMean) {
  const auto map = random_map(256, 256, 0.9);
  const Scene scene = lit(square(map), {sun({0, 0, 1})});
  const Ray ray{{0, 0, 0}, {0.05, 0.02, 1}};
  const RayDifferential wide{{0.5, 0, 0}, {0, 0.5, 0}};
  EXPECT_NEAR(scene.shade(ray, testing::look(scene, ray), wide).radiance, 1, 0.01);
  const RayDifferential narrow{{1e-4, 0, 0}, {0, 1e-4, 0}};
  EXPECT_EQ(scene.shade(ray, testing::look(scene, ray), narrow).radiance,
            scene.shade(ray, testing::look(scene, ray)).radiance);
}

const PinholeCamera kMapCamera{20, 12, 200, 200, 0.5, 4.5, {}};
constexpr double kMapDuration_s = 0.05;

/// A wall with a normal map, and a ball with a finer one that throws a shadow onto it.
Scene mapped_scene(const std::vector<LightOptions>& lights, bool has_environment = false) {
  SceneBuilder builder;
  builder.add(mapped(testing::slanted_wall(), random_map(512, 512, 0.4)),
              Eigen::Affine3d::Identity());
  builder.add(mapped(testing::ball({0.2, 0.1, 2.2}, 0.1, 16, testing::patches(128, 64, 4)),
                     random_map(128, 128, 0.3)),
              Eigen::Affine3d::Identity());
  builder.light(0.05, lights);
  if (has_environment) {
    ImageF sky(16, 8, 0.2F);
    for (int x = 0; x < 16; ++x) sky(x, 1) = 1;
    builder.light_from_around(EnvironmentLight(sky, 0, 1));
  }
  return std::move(builder).build(Background(0.5));
}

std::vector<LightOptions> some_lights() {
  LightOptions near;
  near.position = {0.3, -0.2, 0};
  near.intensity = 12;
  LightOptions far = sun({0.5, 0.3, 1});
  far.intensity = 0.5;
  return {near, far};
}

/// Of a whole scene some events are missed at the facets of its ball, as without normal maps.
TEST(NormalMapEvents, ExactOnesAreThoseOfBruteForce) {
  const Spline motion = testing::lively_motion(kMapDuration_s, 1, 0.5, 3);
  for (const bool has_environment : {false, true}) {
    const Scene scene = mapped_scene(some_lights(), has_environment);
    const testing::Agreement agreement =
        testing::agreement(scene, motion, kMapCamera, testing::in_nanoseconds());
    std::printf("%s\n", agreement.text().c_str());
    EXPECT_GT(agreement.expected, 1000U);
    EXPECT_GT(agreement.share_1_us(), 0.995);
  }
}

TEST(NormalMapEvents, ExactOnesMissNothingOnAWall) {
  SceneBuilder builder;
  builder.add(mapped(testing::slanted_wall(), random_map(1024, 1024, 0.8)),
              Eigen::Affine3d::Identity());
  builder.light(0.02, some_lights());
  const Scene scene = std::move(builder).build(Background(0.5));
  const Spline motion = testing::lively_motion(kMapDuration_s, 2, 1, 3);
  const testing::Agreement agreement =
      testing::agreement(scene, motion, kMapCamera, testing::in_nanoseconds());
  std::printf("%s\n", agreement.text().c_str());
  EXPECT_GT(agreement.expected, 500U);
  EXPECT_GT(agreement.share_1_us(), 0.9995);
}

TEST(NormalMapEvents, ExactOnesAreThoseOfBruteForceWithoutTexture) {
  // No texture at all: the light alone makes events.
  Mesh wall = testing::slanted_wall();
  wall.materials[0].texture = nullptr;
  SceneBuilder builder;
  builder.add(mapped(wall, random_map(512, 512, 0.4)), Eigen::Affine3d::Identity());
  builder.light(0.05, some_lights());
  const Scene scene = std::move(builder).build(Background(0.5));
  const Spline motion = testing::lively_motion(kMapDuration_s, 1, 0.5, 4);
  const testing::Agreement agreement =
      testing::agreement(scene, motion, kMapCamera, testing::in_nanoseconds());
  std::printf("%s\n", agreement.text().c_str());
  EXPECT_GT(agreement.expected, 80U);
  EXPECT_GT(agreement.share_1_us(), 0.999);
}

TEST(NormalMapEvents, AdaptiveOnesAreNearlyTheExactOnes) {
  const Spline motion = testing::lively_motion(kMapDuration_s, 1, 0.5, 3);
  const Scene scene = mapped_scene(some_lights());
  EventOptions options = testing::in_nanoseconds();
  options.audit_fraction = 0;
  for (const TextureFilter filter : {TextureFilter::kBilinear, TextureFilter::kMipmap}) {
    options.texture_filter = filter;
    const Events exact = testing::record(scene, motion, kMapCamera, options).events;
    Events events;
    AdaptiveCamera(scene, motion, kMapCamera, options, 1)
        .record(kMapDuration_s, [&](std::span<const SensedEvent> some, double) {
          for (const SensedEvent& event : some) events.push_back(event.event());
        });
    const auto pairs = static_cast<double>(testing::count_pairs(exact, events, 10'000));
    const double recall = pairs / static_cast<double>(exact.size());
    const double precision = pairs / static_cast<double>(events.size());
    std::printf("%zu exact, %zu adaptive, recall %.4f, precision %.4f\n", exact.size(),
                events.size(), recall, precision);
    EXPECT_GT(recall, 0.985);
    EXPECT_GT(precision, 0.985);
  }
}

}  // namespace
}  // namespace saccade
