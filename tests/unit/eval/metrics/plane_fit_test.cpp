#include "eval/metrics/plane_fit.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

/// `n` points on a square of 2 m about (0, 0, 3), turned about the vertical axis, with noise.
void add_plane(std::vector<Eigen::Vector3d>& points, int n, double yaw_deg, double shift_m) {
  const Random random(static_cast<std::uint64_t>(100 * yaw_deg + 1000));
  const Eigen::Quaterniond turn = so3_exp({0, yaw_deg * M_PI / 180, 0});
  for (int i = 0; i < n; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const Eigen::Vector3d on(2 * random.uniform(0, index) - 1, 2 * random.uniform(1, index) - 1,
                             shift_m + 0.003 * random.normal(2, index));
    points.push_back(turn * on + Eigen::Vector3d(0, 0, 3));
  }
}

TEST(PlaneFit, FindsTheAngleOfTwoPlanesAmongOutliers) {
  std::vector<Eigen::Vector3d> points;
  add_plane(points, 600, 38, 0.5);
  add_plane(points, 400, -52, 0.4);
  const Random random(4);
  for (std::uint64_t i = 0; i < 200; ++i)
    points.emplace_back(4 * random.uniform(0, i) - 2, 4 * random.uniform(1, i) - 2,
                        5 * random.uniform(2, i));
  const auto planes = fit_planes(points, 0.01, 2);
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_NEAR(angle_between_deg(planes[0].plane, planes[1].plane), 90, 0.1);
  EXPECT_NEAR(static_cast<double>(planes[0].points.size()), 600, 20);
  EXPECT_NEAR(static_cast<double>(planes[1].points.size()), 400, 20);
  for (const FittedPlane& plane : planes) EXPECT_NEAR(plane.plane.normal.norm(), 1, 1e-12);
}

TEST(PlaneFit, AnglesAreBelowNinetyWhateverTheSigns) {
  EXPECT_NEAR(angle_between_deg({{0, 0, 1}, 1}, {{0, 0, -1}, 2}), 0, 1e-5);
  EXPECT_NEAR(angle_between_deg({{0, 0, 1}, 1}, {{0, -1, 0}, 2}), 90, 1e-9);
}

TEST(PlaneFit, FewPointsMakeNoPlane) {
  std::vector<Eigen::Vector3d> points;
  add_plane(points, 19, 0, 0);
  EXPECT_TRUE(fit_planes(points, 0.01, 3).empty());
  EXPECT_TRUE(fit_planes({}, 0.01, 3).empty());
  EXPECT_TRUE(fit_planes(std::vector<Eigen::Vector3d>(50, {1, 2, 3}), 0.01, 3).empty())
      << "one point many times spans nothing";
}

}  // namespace
}  // namespace saccade
