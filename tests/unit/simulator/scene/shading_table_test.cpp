#include "simulator/scene/shading_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/random.h"
#include "simulator/scene/ray_lanes.h"
#include "simulator/scene/scene_builder.h"
#include "tests/support/meshes.h"

namespace saccade {
namespace {

LightOptions light_at(const Eigen::Vector3d& position, double intensity) {
  LightOptions light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

LightOptions sun() {
  LightOptions light;
  light.type = LightType::kDirectional;
  light.direction = {1, 2, 3};
  light.intensity = 0.7;
  return light;
}

/// A wall with a round and a smooth thing, one that is cut out, and one of plain albedo before it.
Scene furnished(bool is_lit) {
  SceneBuilder builder;
  const auto still = Eigen::Affine3d::Identity();
  builder.add(testing::slanted_wall(), still);
  builder.add(testing::ball({0.4, 0.1, 2.5}, 0.5, 12, testing::patches(64, 32, 3)), still);
  builder.add(testing::torus({-0.6, -0.3, 2}, 0.3, 0.1, 16, testing::patches(32, 32, 4)), still);
  Mesh screen =
      testing::rectangle({-1, 0.3, 1.8}, {0.8, 0, 0.1}, {0, 0.6, 0}, testing::patches(16, 16, 5));
  ImageF holes(4, 4, 1.0F);
  holes(1, 1) = holes(2, 1) = 0;
  screen.materials[0].opacity = std::make_shared<Texture>(holes, Wrap::kClamp, Wrap::kClamp);
  builder.add(screen, still);
  Mesh plain = testing::rectangle({0.3, -0.9, 2}, {0.5, 0, 0}, {0, 0.5, 0.2}, ImageF(2, 2, 1.0F));
  plain.materials = {Material{0.3, nullptr, 1, nullptr}};
  builder.add(plain, still);
  if (is_lit) builder.light(0.2, {light_at({1, -1.5, 0.5}, 4), sun()});
  return std::move(builder).build(Background(0.4));
}

/// Random rays into the scene from around the origin, and their differentials.
std::array<Ray, kRayPacket> random_rays(std::uint64_t packet) {
  const Random random(17);
  std::array<Ray, kRayPacket> rays;
  for (std::size_t i = 0; i < kRayPacket; ++i) {
    const auto number = [&](std::uint64_t k) { return random.uniform(packet, 5 * i + k) - 0.5; };
    rays[i] = {{0.1 * number(0), 0.1 * number(1), 0.1 * number(2)}, {number(3), number(4), 1}};
  }
  return rays;
}

RayLanes lanes_of(const std::array<Ray, kRayPacket>& rays, const RayDifferential& differential) {
  RayLanes lanes;
  const auto set = [](LaneVectors& target, Eigen::Index lane, const Eigen::Vector3d& vector) {
    target.x[lane] = static_cast<float>(vector.x());
    target.y[lane] = static_cast<float>(vector.y());
    target.z[lane] = static_cast<float>(vector.z());
  };
  for (std::size_t i = 0; i < kRayPacket; ++i) {
    const auto lane = static_cast<Eigen::Index>(i);
    set(lanes.origin, lane, rays[i].origin);
    set(lanes.direction, lane, rays[i].direction);
    set(lanes.right, lane, differential.right);
    set(lanes.down, lane, differential.down);
  }
  return lanes;
}

/// The radiance in double precision and in lanes agree for `count` lanes of many packets.
void expect_same_view(const Scene& scene, bool filtered, std::size_t count) {
  ASSERT_TRUE(scene.has_view());
  // 40 texels of the ball's texture per radian: its pyramid is used.
  const RayDifferential differential{{0.06, 0, 0}, {0, 0.05, 0}};
  std::size_t same = 0;
  std::size_t total = 0;
  for (std::uint64_t packet = 0; packet < 200; ++packet) {
    const std::array<Ray, kRayPacket> rays = random_rays(packet);
    ViewLanes seen;
    scene.view(lanes_of(rays, differential), count, filtered, seen);
    std::array<TriangleId, kRayPacket> triangles;
    scene.visible({rays.data(), count}, {triangles.data(), count});
    for (std::size_t i = 0; i < count; ++i) {
      const auto lane = static_cast<Eigen::Index>(i);
      ++total;
      if (seen.triangles[i] != triangles[i]) continue;  // next to an edge
      SurfaceSample expected = filtered ? scene.sample_surface(rays[i], triangles[i], differential)
                                        : scene.sample_surface(rays[i], triangles[i]);
      scene.illuminate({&rays[i], 1}, {&triangles[i], 1}, {&expected, 1});
      if (seen.lights[i] != expected.lights) continue;  // next to the edge of a shadow
      ++same;
      ASSERT_NEAR(static_cast<double>(seen.radiance[lane]), expected.radiance(), 2e-4);
      ASSERT_NEAR(static_cast<double>(seen.distance[lane]), expected.distance, 1e-5);
      if (triangles[i] == kNothing) {
        ASSERT_EQ(seen.objects[i], kNothing);
        continue;
      }
      ASSERT_EQ(seen.objects[i], scene.object(triangles[i]));
      if (expected.texture == nullptr) continue;
      const double texel = std::exp2(-std::max(expected.level, 0.0));
      ASSERT_NEAR(static_cast<double>(seen.x[lane]), expected.x * texel, 1e-3);
      ASSERT_NEAR(static_cast<double>(seen.y[lane]), expected.y * texel, 1e-3);
    }
  }
  EXPECT_GE(static_cast<double>(same), 0.995 * static_cast<double>(total));
}

TEST(ShadingTable, SeesWhatDoublePrecisionSees) {
  expect_same_view(furnished(false), false, kRayPacket);
}

TEST(ShadingTable, LightsAndShadowsAreThoseOfDoublePrecision) {
  expect_same_view(furnished(true), false, kRayPacket);
}

TEST(ShadingTable, FiltersTexturesOverTheFootprint) {
  expect_same_view(furnished(true), true, kRayPacket);
}

TEST(ShadingTable, APacketNeedNotBeFull) { expect_same_view(furnished(true), false, 5); }

TEST(ShadingTable, IsNotUsedFarFromTheOrigin) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d(Eigen::Translation3d(5e4, 0, 0)));
  EXPECT_FALSE(std::move(builder).build(Background(0.5)).has_view());
}

TEST(ShadingTable, IsNotUsedUnderFlickeringLight) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  LightOptions light = light_at({0, 0, 1}, 1);
  light.flicker.emplace();
  builder.light(0.1, {light});
  EXPECT_FALSE(std::move(builder).build(Background(0.5)).has_view());
}

}  // namespace
}  // namespace saccade
