#include "estimator/odometry/view_turn.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

Rigid3 turned(const Eigen::Vector3d& rotation) { return {so3_exp(rotation), {1, 2, 3}}; }

TEST(ViewTurn, IsTheAngleBetweenViewingDirections) {
  const Rigid3 start = turned({0.3, -0.2, 0.1});
  EXPECT_NEAR(view_turn(start, start), 0, 1e-12);
  EXPECT_NEAR(view_turn(start, start * turned({0, 0.4, 0})), 0.4, 1e-12);
  EXPECT_NEAR(view_turn(start * turned({-0.7, 0, 0}), start), 0.7, 1e-12);
  EXPECT_NEAR(view_turn(start, start * turned({0, 0, 1.5})), 0, 1e-12) << "the view stays";
  EXPECT_NEAR(view_turn(start, start * turned({3.0, 0, 0})), 3.0, 1e-12);
}

TEST(ViewTurn, TheSmallerAngleOfViewCounts) {
  PinholeCamera camera;
  camera.width = 200;
  camera.height = 100;
  camera.fx = camera.fy = 50;
  EXPECT_NEAR(angle_of_view(camera), 2 * std::atan(1.0), 1e-12);
  camera.fx = 1000;
  EXPECT_NEAR(angle_of_view(camera), 2 * std::atan(0.1), 1e-12);
}

}  // namespace
}  // namespace saccade
