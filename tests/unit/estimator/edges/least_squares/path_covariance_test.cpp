#include "estimator/edges/least_squares/path_covariance.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace saccade {
namespace {

TEST(PathCovariance, PosesOfOneTimeHaveOneCovariance) {
  std::vector<TrackedPose> poses(5);
  poses[0].t_ns = 1'000'000'000;
  poses[1].t_ns = poses[2].t_ns = 2'000'000'000;  // frames of a burst
  poses[3].t_ns = 3'000'000'000;
  poses[3].is_gap = true;
  poses[4].t_ns = 4'000'000'000;
  const auto covariances =
      set_sigmas(poses, [](double t_s) { return Matrix6(t_s * Matrix6::Identity()); });
  ASSERT_EQ(covariances.size(), 3U);
  for (const std::size_t i : {0U, 1U, 2U}) {
    const double t_s = i == 2 ? 4 : 1 + static_cast<double>(i);
    EXPECT_EQ(covariances[i].t_s, t_s);
    EXPECT_EQ(covariances[i].covariance(0, 0), t_s);
  }
  // All of them know how well they are known.
  EXPECT_GT(poses[2].position_sigma_m, 0);
  EXPECT_EQ(poses[1].position_sigma_m, poses[2].position_sigma_m);
  EXPECT_GT(poses[3].rotation_sigma_rad, poses[1].rotation_sigma_rad);
}

}  // namespace
}  // namespace saccade
