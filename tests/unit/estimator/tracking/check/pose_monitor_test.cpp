#include "estimator/tracking/check/pose_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace saccade {
namespace {

/// A pose every 2 ms up to `end_s` at which the camera is `position_m` to the right of the start.
std::vector<TrackedPose> path(double end_s, const std::function<double(double)>& position_m) {
  std::vector<TrackedPose> poses;
  for (int i = 0; i * 0.002 <= end_s + 1e-9; ++i) {
    TrackedPose pose;
    pose.t_ns = pose.first_ns = pose.last_ns = ns_from_seconds(i * 0.002);
    pose.world_from_camera = {Eigen::Quaterniond::Identity(), {position_m(i * 0.002), 0, 0}};
    pose.probability = 0.99;
    pose.evidence.depth_m = 2;
    poses.push_back(pose);
  }
  return poses;
}

TEST(ReportGaps, ACameraThatMovesAndSeesNothingIsLost) {
  // 1 m/s before a scene 2 m away passes the limit of 0.1 m after 100 ms; lost at 80 % of it.
  std::vector<TrackedPose> poses = path(0.1, [](double t_s) { return t_s; });
  const std::size_t before = poses.size();
  report_gaps(ns_from_seconds(0.5), poses);
  ASSERT_EQ(poses.size(), before + 1);
  const TrackedPose& lost = poses.back();
  EXPECT_EQ(lost.status, TrackStatus::kLost);
  EXPECT_NEAR(seconds_from_ns(lost.t_ns), 0.18, 1e-6);
  EXPECT_LT(lost.probability, 0.5);
  EXPECT_GT(lost.probability, 0);
  EXPECT_EQ(lost.world_from_camera.translation(),
            poses[before - 1].world_from_camera.translation());
  EXPECT_NEAR(lost_since_s(poses).value(), 0.18, 1e-6);
}

TEST(ReportGaps, BetweenTwoPosesAsWell) {
  std::vector<TrackedPose> poses = path(0.1, [](double t_s) { return t_s; });
  TrackedPose later = poses.back();
  later.t_ns = ns_from_seconds(0.3);
  poses.push_back(later);
  report_gaps(later.t_ns, poses);
  ASSERT_EQ(poses.size(), 51U + 2);
  EXPECT_EQ(poses[51].status, TrackStatus::kLost);
  EXPECT_EQ(poses[52].status, TrackStatus::kOk);
  EXPECT_EQ(lost_since_s(poses), std::nullopt);
}

TEST(ReportGaps, ACameraAtRestIsNotLost) {
  std::vector<TrackedPose> rests = path(0.1, [](double) { return 0.3; });
  report_gaps(ns_from_seconds(5), rests);
  EXPECT_EQ(rests.size(), 51U);
  // It moved by 1 m/s until 30 ms before.
  std::vector<TrackedPose> stops = path(0.1, [](double t_s) { return std::min(t_s, 0.07); });
  report_gaps(ns_from_seconds(5), stops);
  EXPECT_EQ(stops.size(), 51U);
}

TEST(ReportGaps, AShortGapIsNone) {
  std::vector<TrackedPose> poses = path(0.1, [](double t_s) { return 10 * t_s; });
  report_gaps(ns_from_seconds(0.119), poses);
  EXPECT_EQ(poses.size(), 51U);
}

TEST(LostSince, IsTheFirstOfTheLastLostPoses) {
  std::vector<TrackedPose> poses = path(0.01, [](double) { return 0.0; });
  EXPECT_EQ(lost_since_s(poses), std::nullopt);
  EXPECT_EQ(lost_since_s({}), std::nullopt);
  poses[0].status = poses[3].status = poses[4].status = poses[5].status = TrackStatus::kLost;
  EXPECT_NEAR(lost_since_s(poses).value(), 0.006, 1e-9);
  poses[5].status = TrackStatus::kOk;
  EXPECT_EQ(lost_since_s(poses), std::nullopt);
}

}  // namespace
}  // namespace saccade
