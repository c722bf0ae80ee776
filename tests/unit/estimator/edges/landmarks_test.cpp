#include "estimator/edges/landmarks.h"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

PinholeCamera narrow_camera() {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 50;
  camera.cx = 31.5;
  camera.cy = 23.5;
  return camera;
}

/// A landmark that a camera at the origin sees at a pixel.
Landmark landmark_at(double x_px, double y_px, double depth_m) {
  return {depth_m * narrow_camera().ray({x_px, y_px}), 0.01};
}

Edgel edge_at(float x_px, float y_px, float depth_m) { return {{x_px, y_px}, {1, 0}, 1 / depth_m}; }

TEST(ProjectedLandmarks, FindsTheNearestAtTheEdgesDepth) {
  const std::vector<Landmark> landmarks = {landmark_at(20.8, 10, 2), landmark_at(20.3, 10.2, 2),
                                           landmark_at(20.1, 10, 3)};
  const ProjectedLandmarks projected(landmarks, Rigid3(), narrow_camera());
  const auto* near = projected.nearest(edge_at(20, 10, 2.02F), 1.5, 0.1);
  ASSERT_NE(near, nullptr);
  EXPECT_NEAR(near->pixel.x(), 20.3, 1e-9);
  EXPECT_NEAR(near->inverse_depth, 0.5, 1e-9);
  EXPECT_NEAR(near->sigma, 0.005, 1e-9);
}

TEST(ProjectedLandmarks, FindsNoneOutOfReach) {
  const std::vector<Landmark> landmarks = {landmark_at(20, 10, 2)};
  const ProjectedLandmarks projected(landmarks, Rigid3(), narrow_camera());
  EXPECT_EQ(projected.nearest(edge_at(22, 10, 2), 1.5, 0.1), nullptr);
  EXPECT_EQ(projected.nearest(edge_at(20, 10, 2.5F), 1.5, 0.1), nullptr);
}

TEST(ProjectedLandmarks, AreProjectedIntoTheView) {
  // A step of the view to the right moves what it sees to the left.
  const Rigid3 view_from_world(Eigen::Quaterniond::Identity(), {-0.2, 0, 0});
  const std::vector<Landmark> landmarks = {
      landmark_at(30, 20, 2), landmark_at(2, 20, 2), {{0, 0, -1}, 0.01}};
  const ProjectedLandmarks projected(landmarks, view_from_world, narrow_camera());
  const auto* near = projected.nearest(edge_at(25, 20, 2), 1.5, 0.1);
  ASSERT_NE(near, nullptr);
  EXPECT_NEAR(near->pixel.x(), 25, 1e-9);
  // The second has left the picture, the third is behind it.
  EXPECT_EQ(projected.nearest(edge_at(0, 20, 2), 1.5, 0.1), nullptr);
}

TEST(ProjectedLandmarks, EdgesAtTheBorderLookNoFarther) {
  const std::vector<Landmark> landmarks = {landmark_at(63, 47, 2)};
  const ProjectedLandmarks projected(landmarks, Rigid3(), narrow_camera());
  EXPECT_NE(projected.nearest(edge_at(63.4F, 47.4F, 2), 1.5, 0.1), nullptr);
  EXPECT_EQ(projected.nearest(edge_at(-30, 90, 2), 1.5, 0.1), nullptr);
}

}  // namespace
}  // namespace saccade
