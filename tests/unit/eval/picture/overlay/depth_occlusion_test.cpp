#include "eval/picture/overlay/depth_occlusion.h"

#include <gtest/gtest.h>

#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{81, 61, 100, 100, 40, 30};

PosedDepthMap view_of(const ImageF& depth, const Rigid3& map_from_camera = {}) {
  return {depth, kCamera, map_from_camera};
}

/// A surface 1 m away on the left, nothing on the right.
ImageF left_half() {
  ImageF depth(kCamera.width, kCamera.height, 0);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < 40; ++x) depth(x, y) = 1;
  return depth;
}

TEST(DepthOcclusion, WhatIsNearerHides) {
  const std::vector<PosedDepthMap> views = {view_of(left_half())};
  EXPECT_TRUE(is_occluded(views, {-0.2, 0, 2}));
  EXPECT_FALSE(is_occluded(views, {0.2, 0, 2}));
  EXPECT_FALSE(is_occluded(views, {-0.1, 0, 0.9}));
  // On the surface itself, a little behind, and further behind.
  EXPECT_FALSE(is_occluded(views, {-0.1, 0, 1}));
  EXPECT_FALSE(is_occluded(views, {-0.1, 0, 1.009}));
  EXPECT_TRUE(is_occluded(views, {-0.1, 0, 1.011}));
}

TEST(DepthOcclusion, WhatNoMapSeesIsNotHidden) {
  const std::vector<PosedDepthMap> views = {view_of(left_half())};
  EXPECT_FALSE(is_occluded({}, {-0.2, 0, 2}));
  EXPECT_FALSE(is_occluded(views, {-2, 0, 2}));
  EXPECT_FALSE(is_occluded(views, {-0.2, 0, -2}));
}

TEST(DepthOcclusion, PointsAreCarriedToTheMapsOwnTime) {
  // When the map was made the points were 0.4 m further to the right: those of the left half on
  // the right, where it saw nothing. And the other way round.
  const Rigid3 to_the_right(Eigen::Quaterniond::Identity(), {0.4, 0, 0});
  EXPECT_FALSE(is_occluded({view_of(left_half(), to_the_right)}, {-0.2, 0, 2}));
  EXPECT_TRUE(is_occluded({view_of(left_half(), to_the_right.inverse())}, {0.2, 0, 2}));
}

TEST(DepthOcclusion, TheFirstMapThatSeesThePointDecides) {
  const Rigid3 away(Eigen::Quaterniond::Identity(), {50, 0, 0});
  const ImageF far(kCamera.width, kCamera.height, 9);
  EXPECT_TRUE(is_occluded({view_of(far, away), view_of(left_half())}, {-0.2, 0, 2}));
  EXPECT_FALSE(is_occluded({view_of(far), view_of(left_half())}, {-0.2, 0, 2}));
}

TEST(DepthOcclusion, ThroughALensThePixelIsTheDistortedOne) {
  PinholeCamera lens = kCamera;
  lens.distortion = {-0.4, 0, 0, 0, 0};
  ImageF depth(kCamera.width, kCamera.height, 0);
  const Eigen::Vector3d point(-0.6, 0, 2);
  const Eigen::Vector2d seen = lens.distort(kCamera.project(point));
  ASSERT_GT((seen - kCamera.project(point)).norm(), 1);
  depth(static_cast<int>(std::lround(seen.x())), static_cast<int>(std::lround(seen.y()))) = 1;
  EXPECT_TRUE(is_occluded({{depth, lens, {}}}, point));
  // Where the model folds over and leads back into the image, the camera sees nothing.
  const ImageF near(kCamera.width, kCamera.height, 1);
  const Eigen::Vector3d outside(3.1, 0, 2);
  ASSERT_TRUE(kCamera.contains(lens.distort(kCamera.project(outside))));
  EXPECT_FALSE(is_occluded({{near, lens, {}}}, outside));
}

using DepthViewsNear = testing::FakeFolders;

TEST_F(DepthViewsNear, AreTheNeighboursInTime) {
  const Dataset data = Dataset::open(dataset());  // a map every 1 / 24 s from 0 to 0.25 s
  const auto views_at = [&](double t_s) { return depth_maps_near(data, data.groundtruth(), t_s); };
  const std::vector<PosedDepthMap> between = views_at(1.2 / 24);
  ASSERT_EQ(between.size(), 2U);
  EXPECT_EQ(between[0].depth, data.load_depth(1));
  EXPECT_EQ(between[1].depth, data.load_depth(2));
  const Rigid3 expected = data.groundtruth().at_clamped(data.depth_maps()[1].t_s).inverse() *
                          data.groundtruth().at_clamped(1.2 / 24);
  EXPECT_LT((between[0].map_from_camera.inverse() * expected).log().norm(), 1e-12);
  EXPECT_EQ(views_at(1.9 / 24)[0].depth, data.load_depth(2));
  const double last_s = data.depth_maps().back().t_s;
  EXPECT_EQ(views_at(last_s + 0.03).size(), 1U);
  EXPECT_TRUE(views_at(last_s + 0.05).empty());
  EXPECT_TRUE(views_at(-0.05).empty());
}

}  // namespace
}  // namespace saccade
