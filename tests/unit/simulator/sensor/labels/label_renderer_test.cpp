#include "simulator/sensor/labels/label_renderer.h"

#include <gtest/gtest.h>

#include "core/process/parallel.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{61, 46, 100, 100, 30, 22.5, {}};
const ImageF kGrey(2, 2, 0.5F);

/// A wall, a rectangle of 10 x 10 pixels before it and one of 11 x 6 before both, which hides 30
/// pixels of the second.
Scene layers() {
  SceneBuilder builder;
  const auto add = [&](const Mesh& mesh, std::uint8_t class_id) {
    builder.add(mesh, Eigen::Affine3d::Identity(), {"mesh", "mesh.obj", class_id, false});
  };
  add(testing::rectangle({-9, -9, 4}, {18, 0, 0}, {0, 18, 0}, kGrey), 0);
  add(testing::rectangle({0.015, -0.14, 3}, {0.3, 0, 0}, {0, 0.28, 0}, kGrey), 3);
  add(testing::rectangle({-0.105, -0.055, 2}, {0.21, 0, 0}, {0, 0.11, 0}, kGrey), 255);
  return std::move(builder).build(Background(0.5));
}

TEST(LabelRenderer, MaskAndBoxesOfRectanglesBehindOneAnother) {
  const Scene scene = layers();
  const LabelRenderer renderer(scene, kCamera);
  const InstanceMask mask = renderer.mask({});
  for (int y = 0; y < 46; ++y)
    for (int x = 0; x < 61; ++x) {
      const bool nearest = x >= 25 && x <= 35 && y >= 20 && y <= 25;
      const bool middle = x >= 31 && x <= 40 && y >= 18 && y <= 27;
      EXPECT_EQ(mask.instances(x, y), nearest ? 3 : middle ? 2 : 1) << x << " " << y;
      EXPECT_EQ(mask.classes(x, y), nearest ? 255 : middle ? 3 : 0);
    }
  const std::vector<InstanceBox> boxes = renderer.boxes({}, mask);
  ASSERT_EQ(boxes.size(), 3U);
  EXPECT_EQ(boxes[0], (InstanceBox{0, 1, 0, 0, 0, 60, 45, (61.0 * 46 - 136) / (61.0 * 46)}));
  EXPECT_EQ(boxes[1], (InstanceBox{0, 2, 3, 31, 18, 40, 27, 0.7}));
  EXPECT_EQ(boxes[2], (InstanceBox{0, 3, 255, 25, 20, 35, 25, 1}));
}

TEST(LabelRenderer, BackgroundAndWhatIsOutOfSightHaveNoBox) {
  SceneBuilder builder;
  builder.add(testing::rectangle({50, 0, 2}, {1, 0, 0}, {0, 1, 0}, kGrey),
              Eigen::Affine3d::Identity());
  builder.add(testing::rectangle({0, 0, 2}, {9, 0, 0}, {0, 9, 0}, kGrey),
              Eigen::Affine3d::Identity());
  const Scene scene = std::move(builder).build(Background(0.5));
  const LabelRenderer renderer(scene, kCamera);
  const InstanceMask mask = renderer.mask({});
  EXPECT_EQ(mask.instances(0, 0), 0);
  EXPECT_EQ(mask.instances(60, 45), 2);
  const std::vector<InstanceBox> boxes = renderer.boxes({}, mask);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_EQ(boxes[0].instance, 2);
  EXPECT_EQ(boxes[0].x1, 60);
  const NormalMap normals = renderer.normals({});
  EXPECT_EQ(normals.z(0, 0), 0);
  EXPECT_EQ(normals.z(60, 45), -1);
}

TEST(LabelRenderer, ASolidIsWholeAlthoughItHidesItsOwnBack) {
  SceneBuilder builder;
  Eigen::Affine3d before = Eigen::Affine3d::Identity();
  before.translation() = Eigen::Vector3d(0.02, 0.01, 3);
  builder.add(testing::box({0.4, 0.3, 0.5}, kGrey), before);
  const Scene scene = std::move(builder).build(Background(0.5));
  const LabelRenderer renderer(scene, kCamera);
  const std::vector<InstanceBox> boxes = renderer.boxes({}, renderer.mask({}));
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_EQ(boxes[0].visible_fraction, 1);
}

TEST(LabelRenderer, NormalsOfAPlaneInTheCameraThatMovesAndTurns) {
  const Eigen::Vector3d right(18, 0, 3);
  const Eigen::Vector3d down(0, 18, 5);
  SceneBuilder still, moving;
  const Mesh plane = testing::rectangle({-9, -9, 4}, right, down, kGrey);
  still.add(plane, Eigen::Affine3d::Identity());
  const Rigid3 pose(so3_exp({0.1, -0.2, 0.3}), {0.2, 0.1, -0.1});
  const Rigid3 object(so3_exp({-0.1, 0.05, 0.2}), {0.1, 0, 0.2});
  const std::vector<StampedPose> motion{{0, Rigid3()}, {1, object}};
  moving.add_moving(plane, Eigen::Affine3d::Identity(), Spline::interpolate(motion));
  const Scene still_scene = std::move(still).build(Background(0.5));
  const Scene moving_scene = std::move(moving).build(Background(0.5));
  const auto expect_normal = [&](const Scene& scene, Eigen::Vector3d normal) {
    normal = pose.rotation().conjugate() * normal;
    if (normal.z() > 0) normal = -normal;
    const NormalMap map = LabelRenderer(scene, kCamera).normals({1, pose});
    for (int y = 0; y < 46; y += 5)
      for (int x = 0; x < 61; x += 4) {
        EXPECT_NEAR(map.x(x, y), normal.x(), 1e-6);
        EXPECT_NEAR(map.y(x, y), normal.y(), 1e-6);
        EXPECT_NEAR(map.z(x, y), normal.z(), 1e-6);
      }
  };
  const Eigen::Vector3d normal = right.cross(down).normalized();
  expect_normal(still_scene, normal);
  expect_normal(moving_scene, object.rotation() * normal);
}

TEST(LabelRenderer, DoesNotDependOnTheThreads) {
  const Scene scene = layers();
  const LabelRenderer renderer(scene, kCamera);
  const StampedPose pose{0, {so3_exp({0.02, 0.03, 0.1}), {0.05, 0.02, 0}}};
  set_thread_count(1);
  const InstanceMask mask = renderer.mask(pose);
  const std::vector<InstanceBox> boxes = renderer.boxes(pose, mask);
  set_thread_count(4);
  EXPECT_EQ(renderer.mask(pose).instances, mask.instances);
  EXPECT_EQ(renderer.boxes(pose, mask), boxes);
  set_thread_count(0);
}

}  // namespace
}  // namespace saccade
