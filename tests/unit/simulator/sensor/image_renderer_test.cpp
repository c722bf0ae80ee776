#include "simulator/sensor/image_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;

/// A camera with a strong lens that also moves and turns.
struct TiltedPlane {
  PinholeCamera camera{41, 30, 60, 63, 21, 14, {-0.2, 0.05, 0.003, -0.002, 0}};
  Eigen::Vector3d corner{-20, -20, 1.5};
  Eigen::Vector3d right{40, 0, 3};
  Eigen::Vector3d down{0, 40, 5};
  Scene scene = testing::scene_of({testing::rectangle(corner, right, down, ImageF(2, 2, 0.4F))});
  Rigid3 pose{Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, -2, 3).normalized())),
              {0.3, -0.2, 0.1}};

  /// Where the ray of an undistorted pixel direction intersects the plane, as z depth.
  [[nodiscard]] double depth(const Rigid3& world_from_camera, const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d normal = right.cross(down);
    return normal.dot(corner - world_from_camera.translation()) /
           normal.dot(world_from_camera.rotation() * ray);
  }
};

TEST(ImageRenderer, DepthOfATiltedPlane) {
  const TiltedPlane world;
  const ImageF depth = ImageRenderer(world.scene, world.camera, 4).depth({0, world.pose});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 41; ++x) {
      const Eigen::Vector3d ray = world.camera.ray(world.camera.undistort({x, y}));
      EXPECT_NEAR(depth(x, y), world.depth(world.pose, ray), 1e-6 * depth(x, y));
    }
}

TEST(ImageRenderer, BackgroundHasNoDepth) {
  const Scene scene =
      testing::scene_of({testing::rectangle({0, 0, 2}, {9, 0, 0}, {0, 9, 0}, ImageF(2, 2, 0.4F))});
  const ImageRenderer renderer(scene, {9, 7, 20, 20, 4, 3, {}}, 1);
  const ImageF depth = renderer.depth({});
  const ImageF radiance = renderer.radiance(std::vector<StampedPose>(1));
  EXPECT_EQ(depth(0, 0), 0);
  EXPECT_EQ(radiance(0, 0), 0.5F);
  EXPECT_FLOAT_EQ(depth(8, 6), 2);
  EXPECT_FLOAT_EQ(radiance(8, 6), 0.4F);
}

TEST(ImageRenderer, RadianceIsThatOfTheTextureAndAveragesOverPoses) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(20, 14);
  const Scene scene = testing::scene_of(plane);
  const ImageRenderer renderer(scene, plane.camera, 1);
  const Spline motion = plane.motion();
  const std::vector<StampedPose> poses{{0.1, motion.pose(0.1)}, {0.35, motion.pose(0.35)}};
  const ImageF image = renderer.radiance(poses);
  for (int y = 0; y < 14; ++y)
    for (int x = 0; x < 20; ++x) {
      const Eigen::Vector2d a = plane.texel(x, y, 0.1);
      const Eigen::Vector2d b = plane.texel(x, y, 0.35);
      const double mean =
          0.5 * (sample(plane.texture, a.x(), a.y()) + sample(plane.texture, b.x(), b.y()));
      EXPECT_NEAR(image(x, y), mean, 1e-6 * mean);
    }
}

TEST(ImageRenderer, FlowIsTheMotionOfTheSeenPoint) {
  const TiltedPlane world;
  SplineState state;
  state.world_from_body = world.pose;
  state.velocity_in_world = {0.4, 0.7, -0.3};
  state.angular_velocity_in_body = {0.5, -0.8, 1.1};
  const FlowField flow = ImageRenderer(world.scene, world.camera, 1).flow(state, 0);
  constexpr double kStep_s = 1e-4;
  const auto pose_at = [&](double t) {
    return Rigid3(world.pose.rotation() * so3_exp(t * state.angular_velocity_in_body),
                  world.pose.translation() + t * state.velocity_in_world);
  };
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 41; ++x) {
      const Eigen::Vector3d ray = world.camera.ray(world.camera.undistort({x, y}));
      const Eigen::Vector3d point = world.pose * (world.depth(world.pose, ray) * ray);
      const auto pixel_at = [&](double t) {
        return world.camera.distort(world.camera.project(pose_at(t).inverse() * point));
      };
      const Eigen::Vector2d expected = (pixel_at(kStep_s) - pixel_at(-kStep_s)) / (2 * kStep_s);
      EXPECT_NEAR(flow.u(x, y), expected.x(), 1e-4 * (1 + expected.norm()));
      EXPECT_NEAR(flow.v(x, y), expected.y(), 1e-4 * (1 + expected.norm()));
    }
}

ImageF checkerboard(int size) {
  ImageF image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) image(x, y) = (x + y) % 2 == 0 ? 0.1F : 0.9F;
  return image;
}

double spread_of(const ImageF& image) {
  const auto [low, high] = std::minmax_element(image.pixels().begin(), image.pixels().end());
  return static_cast<double>(*high - *low);
}

TEST(TextureFilter, FineTextureIsItsMeanInsteadOfAliasing) {
  // 1024 texels on 4 m, seen at 3 m with 40 px of focal length: 19 texels a pixel.
  const Scene scene = testing::scene_of(
      {testing::rectangle({-2, -2, 3}, {4, 0, 0}, {0, 4, 0.5}, checkerboard(1024))});
  const PinholeCamera camera{31, 23, 40, 40, 15, 11, {-0.1, 0, 0, 0, 0}};
  const std::vector<StampedPose> pose{{0, {so3_exp({0.02, 0.03, 0.1}), {0.01, 0.02, 0}}}};
  const ImageF point = ImageRenderer(scene, camera, 1).radiance(pose);
  EXPECT_GT(spread_of(point), 0.5);
  for (const int rays : {1, 4}) {
    const ImageF mean = ImageRenderer(scene, camera, rays, TextureFilter::kMipmap).radiance(pose);
    EXPECT_LT(spread_of(mean), 0.01) << rays;
    EXPECT_NEAR(mean(15, 11), 0.5, 0.005) << rays;
  }
}

TEST(TextureFilter, CoarseTextureStaysAsItIs) {
  const Scene scene = testing::scene_of(
      {testing::rectangle({-2, -2, 3}, {4, 0, 0}, {0, 4, 0.5}, checkerboard(16))});
  const PinholeCamera camera{31, 23, 40, 40, 15, 11, {}};
  const std::vector<StampedPose> pose{{0, {so3_exp({0.02, 0.03, 0.1}), {0.01, 0.02, 0}}}};
  EXPECT_EQ(ImageRenderer(scene, camera, 1).radiance(pose),
            ImageRenderer(scene, camera, 1, TextureFilter::kMipmap).radiance(pose));
}

TEST(TextureFilter, LevelIsTheLargerTexelStepToTheNextPixel) {
  const Scene scene = testing::scene_of(
      {testing::rectangle({-20, -20, 5}, {40, 0, 0}, {0, 40, 25}, checkerboard(1024))});
  const PinholeCamera camera{31, 23, 40, 44, 15, 11, {-0.2, 0.05, 0.003, -0.002, 0}};
  const PixelRays rays(camera, 1);
  constexpr double kStep_px = 1e-4;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(3, 4), {15, 11}, {29, 20}}) {
    const auto look = [&](double dx, double dy) {
      const Eigen::Vector2d moved = pixel + Eigen::Vector2d(dx, dy);
      const Ray ray{{0, 0, 0}, camera.ray(camera.undistort(moved))};
      TriangleId triangle = kNothing;
      scene.visible({&ray, 1}, {&triangle, 1});
      const Eigen::Matrix2d s = rays.differential(ray.direction);
      return scene.sample_surface(ray, triangle, {{s(0, 0), s(1, 0), 0}, {s(0, 1), s(1, 1), 0}});
    };
    const auto step = [&](double dx, double dy) {
      const SurfaceSample a = look(-dx, -dy);
      const SurfaceSample b = look(dx, dy);
      return std::hypot(b.x - a.x, b.y - a.y) / (2 * kStep_px);
    };
    const double expected = std::log2(std::max(step(kStep_px, 0), step(0, kStep_px)));
    EXPECT_GT(expected, 0.5);
    EXPECT_NEAR(look(0, 0).level, expected, 1e-4);
  }
}

}  // namespace
}  // namespace saccade
