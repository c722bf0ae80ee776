#include "tests/unit/simulator/brute_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "simulator/sensor/event_camera.h"
#include "tests/support/planar_world.h"
#include "tests/unit/simulator/plane_scene.h"

namespace saccade {
namespace {

ImageF patches(std::uint64_t seed) {
  ImageF image = testing::patch_texture(128, 128, seed);
  for (float& value : image.pixels()) value = std::exp(value);
  return image;
}

/// A ball of 2 * `rings` * `rings` triangles.
Mesh ball(const Eigen::Vector3d& centre, double radius, std::uint32_t rings, ImageF texture) {
  Mesh mesh;
  const std::uint32_t columns = 2 * rings;
  for (std::uint32_t j = 0; j <= rings; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double latitude = std::numbers::pi * (static_cast<double>(j) / rings - 0.5);
      const double longitude = 2 * std::numbers::pi * static_cast<double>(i) / columns;
      mesh.vertices.push_back(centre +
                              radius * Eigen::Vector3d(std::cos(latitude) * std::cos(longitude),
                                                       std::sin(latitude),
                                                       std::cos(latitude) * std::sin(longitude)));
      mesh.uvs.emplace_back(static_cast<double>(i) / columns, static_cast<double>(j) / rings);
    }
  for (std::uint32_t j = 0; j < rings; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i;
      const std::uint32_t b = a + columns + 1;
      mesh.triangles.push_back({{a, a + 1, b}, 0});
      mesh.triangles.push_back({{b, a + 1, b + 1}, 0});
    }
  Material material;
  material.texture = std::make_shared<const Texture>(std::move(texture));
  mesh.materials = {material};
  return mesh;
}

/// Translation, rotation and a change of speed within a fifth of a second.
Spline lively_motion() {
  std::vector<StampedPose> poses(11);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double t = 0.02 * static_cast<double>(k);
    poses[k].t_s = t;
    poses[k].world_from_camera =
        Rigid3(so3_exp({0.05 * std::sin(12 * t), 0.06 * std::cos(9 * t), 0.08 * std::sin(7 * t)}),
               {0.15 * std::sin(8 * t), 0.1 * std::cos(11 * t), 0.4 * t});
  }
  return Spline::interpolate(poses);
}

/// A crop of a 240 x 180 px image, f = 200 px, whose centre is pixel (x, y).
PinholeCamera crop_at(double x, double y) {
  constexpr int kWidth = 22;
  constexpr int kHeight = 16;
  return {kWidth, kHeight, 200, 200, 119.5 - x + 0.5 * kWidth, 89.5 - y + 0.5 * kHeight, {}};
}

void expect_agreement(const Scene& scene, const PinholeCamera& camera, EventOptions options = {},
                      std::size_t least_events = 2000) {
  const Spline motion = lively_motion();
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const Events truth = testing::brute_force(scene, motion, camera, options, 1e-5);
  Events events;
  EventCamera sensor(scene, motion, camera, options);
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> some, double) {
    for (const SensedEvent& event : some) events.push_back(event.event());
  });
  const auto found = static_cast<double>(events.size());
  const auto expected = static_cast<double>(truth.size());
  const auto at_10_us = static_cast<double>(testing::count_pairs(events, truth, 10'000));
  const auto at_1_us = static_cast<double>(testing::count_pairs(events, truth, 1'000));
  std::printf(
      "%zu events, %zu by brute force; precision and recall at 10 us %.5f %.5f, at 1 us "
      "%.5f %.5f; %.1f rays and %.1f surface looks per event\n",
      events.size(), truth.size(), at_10_us / found, at_10_us / expected, at_1_us / found,
      at_1_us / expected, static_cast<double>(sensor.statistics().rays) / found,
      static_cast<double>(sensor.statistics().surface_looks) / found);
  EXPECT_GT(truth.size(), least_events);
  EXPECT_GE(at_10_us, 0.999 * found);
  EXPECT_GE(at_10_us, 0.999 * expected);
  EXPECT_GE(at_1_us, 0.99 * found);
  EXPECT_GE(at_1_us, 0.99 * expected);
}

TEST(EventCameraAgainstBruteForce, TexturedPlanesThatHideOneAnother) {
  const Scene scene = testing::scene_of(
      {testing::rectangle({-6, -5, 4}, {12, 0, 1}, {0, 10, 0}, patches(1)),
       testing::rectangle({-0.5, -0.6, 2}, {0.9, 0.3, 0.2}, {-0.3, 0.9, 0}, patches(2)),
       testing::rectangle({0.1, -0.2, 1.2}, {0.3, 0.05, 0}, {-0.05, 0.3, 0.1}, patches(3))});
  expect_agreement(scene, crop_at(135, 90));
}

TEST(EventCameraAgainstBruteForce, CurvedMesh) {
  const Scene scene =
      testing::scene_of({testing::rectangle({-6, -5, 4}, {12, 0, 1}, {0, 10, 0}, patches(1)),
                         ball({0.1, 0.1, 2.2}, 0.45, 60, patches(4))});
  expect_agreement(scene, crop_at(150, 100));
}

/// Fine textures, seen at levels from 0 to 2, one of them at a slant.
Scene fine_planes() {
  ImageF fine(512, 512);
  const ImageF coarse = patches(5);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) fine(x, y) = coarse(x % 128, y % 128);
  return testing::scene_of(
      {testing::rectangle({-3, -2.5, 4}, {6, 0, 3}, {0, 5, 0}, fine),
       testing::rectangle({-0.5, -0.6, 2}, {0.9, 0.3, 0.2}, {-0.3, 0.9, 0}, patches(2)),
       testing::rectangle({0.1, -0.2, 1.2}, {0.3, 0.05, 0}, {-0.05, 0.3, 0.1}, patches(3))});
}

PinholeCamera quarter(PinholeCamera camera) {
  camera.width = 10;
  camera.height = 8;
  return camera;
}

TEST(EventCameraAgainstBruteForce, FilteredTextures) {
  EventOptions options;
  options.contrast = {0.05, 0.05};
  options.texture_filter = TextureFilter::kMipmap;
  expect_agreement(fine_planes(), crop_at(135, 90), options, 1500);
}

TEST(EventCameraAgainstBruteForce, FilteredTexturesThroughSeveralRays) {
  EventOptions options;
  options.contrast = {0.05, 0.05};
  options.texture_filter = TextureFilter::kMipmap;
  options.samples_per_pixel = 4;
  expect_agreement(fine_planes(), quarter(crop_at(135, 90)), options, 200);
}

}  // namespace
}  // namespace saccade
