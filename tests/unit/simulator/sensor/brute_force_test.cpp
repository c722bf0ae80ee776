#include "tests/support/brute_force.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "core/random.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::patches;

/// A crop of a 240 x 180 px image, f = 200 px, whose centre is pixel (x, y).
PinholeCamera crop_at(double x, double y, int width = 22, int height = 16) {
  return {width, height, 200, 200, 119.5 - x + 0.5 * width, 89.5 - y + 0.5 * height, {}};
}

void expect_agreement(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                      double least_10_us, double least_1_us, const EventOptions& options = {},
                      double step_s = 1e-5) {
  const testing::Agreement result = testing::agreement(scene, motion, camera, options, step_s);
  std::printf("%s\n", result.text().c_str());
  EXPECT_GT(result.expected, 400U);
  EXPECT_GE(result.share_10_us(), least_10_us);
  EXPECT_GE(result.share_1_us(), least_1_us);
}

TEST(EventCameraAgainstBruteForce, TexturedPlanesThatHideOneAnother) {
  const Scene scene = testing::scene_of(
      {testing::slanted_wall(),
       testing::rectangle({-0.5, -0.6, 2}, {0.9, 0.3, 0.2}, {-0.3, 0.9, 0}, patches(128, 128, 2)),
       testing::rectangle({0.1, -0.2, 1.2}, {0.3, 0.05, 0}, {-0.05, 0.3, 0.1},
                          patches(128, 128, 3))});
  for (const int rays : {1, 4}) {
    EventOptions options;
    options.samples_per_pixel = rays;
    expect_agreement(scene, testing::lively_motion(0.1, 1.5, 0.8, 1), crop_at(135, 90), 0.999, 0.99,
                     options);
  }
}

TEST(EventCameraAgainstBruteForce, CurvedMeshes) {
  for (const std::uint32_t rings : {16U, 160U}) {
    const Scene scene =
        testing::scene_of({testing::slanted_wall(),
                           testing::ball({0.1, 0.1, 2.2}, 0.45, rings, patches(256, 128, 4))});
    expect_agreement(scene, testing::lively_motion(0.1, 1.5, 0.8, 2), crop_at(150, 100), 0.999,
                     0.99);
  }
  const Scene scene = testing::scene_of(
      {testing::slanted_wall(), testing::torus({0, 0.1, 2}, 0.4, 0.12, 60, patches(256, 128, 5))});
  expect_agreement(scene, testing::lively_motion(0.1, 1.5, 0.8, 3), crop_at(150, 100), 0.999, 0.99);
}

// Fine textures, seen at levels of their pyramids from 0 to 2, one of them at a slant.
TEST(EventCameraAgainstBruteForce, FilteredTextures) {
  const Scene scene = testing::scene_of(
      {testing::rectangle({-3, -2.5, 4}, {6, 0, 3}, {0, 5, 0}, patches(512, 512, 5)),
       testing::rectangle({-0.5, -0.6, 2}, {0.9, 0.3, 0.2}, {-0.3, 0.9, 0}, patches(128, 128, 2))});
  EventOptions options;
  options.contrast = {0.05, 0.05};
  options.texture_filter = TextureFilter::kMipmap;
  for (const int rays : {1, 4}) {
    options.samples_per_pixel = rays;
    expect_agreement(scene, testing::lively_motion(0.1, 1.5, 0.8, 1), crop_at(135, 90, 12, 8),
                     0.999, 0.99, options);
  }
}

/// Dark bars of 0.2, 0.3 and 0.5 px before a textured wall, upright and slanted.
std::vector<Mesh> bars() {
  std::vector<Mesh> meshes;
  constexpr double kPixel_m = 1.0 / 200;  // at z = 1
  for (int k = 0; k < 12; ++k) {
    const double width =
        kPixel_m * std::vector<double>{0.2, 0.3, 0.5}[static_cast<std::size_t>(k) % 3];
    const double slant = k < 6 ? 0 : 0.15 * (k - 8);
    meshes.push_back(testing::rectangle({-0.12 + 0.02 * k, -0.5, 1}, {width, 0, 0}, {slant, 1, 0},
                                        ImageF(2, 2, 0.02F)));
  }
  return meshes;
}

TEST(EventCameraAgainstBruteForce, BarsThinnerThanAPixel) {
  std::vector<Mesh> meshes = bars();
  meshes.push_back(testing::slanted_wall());
  const Scene scene = testing::scene_of(meshes);
  for (const std::uint64_t seed : {1, 2, 3})
    expect_agreement(scene, testing::lively_motion(0.06, 1, 0.7, seed), crop_at(119, 89), 0.99,
                     0.99);
}

TEST(EventCameraAgainstBruteForce, MovingBarsThinnerThanAPixel) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  const std::vector<Mesh> meshes = bars();
  for (std::uint64_t k = 0; k < meshes.size(); k += 2)
    builder.add_moving(meshes[k], Eigen::Affine3d::Identity(),
                       testing::lively_motion(0.06, 1.5, 0.5, 20 + k));
  const Scene scene = std::move(builder).build(Background(0.5));
  expect_agreement(scene, testing::lively_motion(0.06, 0.5, 0.5, 5), crop_at(119, 89), 0.99, 0.99);
}

/// Boxes, balls and quads at random, some cut out, some moving, some lit.
class RandomWorld : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  double draw(double low, double high) { return low + (high - low) * random_.uniform(1, count_++); }
  Eigen::Vector3d point(double extent) {
    return {draw(-extent, extent), draw(-extent, extent), draw(-extent, extent)};
  }
  ImageF texture() {
    const int size = 16 << random_.below(5, 2, count_++);
    return patches(size, size, random_.below(1000, 3, count_++));
  }

  Mesh mesh() {
    switch (random_.below(4, 4, count_++)) {
      case 0:
        return testing::box({draw(0.1, 0.5), draw(0.1, 0.5), draw(0.1, 0.5)}, texture());
      case 1:
        return testing::ball({0, 0, 0}, draw(0.1, 0.3), 20, texture());
      case 2: {
        Mesh quad = testing::rectangle({-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0}, texture());
        quad.materials[0].opacity = std::make_shared<const Texture>(texture());
        return quad;
      }
      default: {
        Mesh quad = testing::rectangle({-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0}, ImageF(2, 2, 1));
        quad.materials[0].texture = nullptr;
        quad.colours = {0.1, 0.9, 0.4, 0.2};
        return quad;
      }
    }
  }

  Scene scene() {
    SceneBuilder builder;
    const bool is_open = GetParam() % 2 == 0;
    if (!is_open) builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
    for (int k = 0; k < 12; ++k) {
      const Eigen::Affine3d pose = Eigen::Translation3d(point(0.5) + Eigen::Vector3d(0, 0, 1.8)) *
                                   Eigen::Affine3d(so3_exp(point(3)).toRotationMatrix());
      if (k % 4 == 3)
        builder.add_moving(mesh(), pose,
                           testing::lively_motion(kDuration_s, 1, 0.5, GetParam() + 100));
      else
        builder.add(mesh(), pose);
    }
    if (GetParam() % 3 == 0) {
      LightOptions lamp;
      lamp.position = {1, -1, 0};
      lamp.intensity = 3;
      builder.light(0.3, {lamp});
    }
    return std::move(builder).build(is_open ? Background(patches(512, 256, GetParam()))
                                            : Background(0.5));
  }

  static constexpr double kDuration_s = 0.05;
  Random random_{GetParam()};
  std::uint64_t count_ = 0;
};

// Shadows narrower than a step of the sensor may escape the sensor. In world 8 things show for 3
// and for 7 us, which escape brute force on its usual grid.
TEST_P(RandomWorld, Agrees) {
  EventOptions options;
  options.samples_per_pixel = GetParam() % 5 == 0 ? 4 : 1;
  expect_agreement(scene(), testing::lively_motion(kDuration_s, 1.5, 1, GetParam()),
                   crop_at(119, 89, 20, 12), 0.999, 0.99, options, GetParam() == 8 ? 1e-6 : 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomWorld, ::testing::Range<std::uint64_t>(1, 13));

}  // namespace
}  // namespace saccade
