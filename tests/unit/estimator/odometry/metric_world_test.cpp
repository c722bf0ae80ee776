#include "estimator/odometry/metric_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/handheld_motion.h"

namespace saccade {
namespace {

using Status = InertialAlignment::Status;

constexpr double kScale = 2;
const Rigid3 kPathFromWorld(so3_exp({0.4, -0.7, 0.2}), {0, 0, 0});

/// Poses of a motion in a tilted world whose unit is kScale metres.
std::vector<TrackedPose> poses_of(const Spline& motion) {
  std::vector<TrackedPose> poses;
  for (int i = 0; i <= static_cast<int>(200 * motion.end_s()); ++i) {
    const Rigid3 pose = kPathFromWorld * motion.pose(0.005 * i);
    TrackedPose tracked;
    tracked.t_ns = ns_from_seconds(0.005 * i);
    tracked.world_from_camera = {pose.rotation(), pose.translation() / kScale};
    tracked.position_sigma_m = 0.01;
    poses.push_back(tracked);
  }
  return poses;
}

Keyframe keyframe_at(const Rigid3& pose) {
  Keyframe keyframe;
  keyframe.world_from_camera = pose;
  keyframe.typical_depth_m = 1;
  keyframe.depth.points.push_back({10, 20, 0.5F, 0.01F, {1, 0}});
  const Eigen::Vector3f point = (pose * Eigen::Vector3d(0, 0, 2)).cast<float>();
  keyframe.edges = {{point.x()}, {point.y()}, {point.z()}};
  return keyframe;
}

TEST(MetricWorld, IsInMetresAndUpright) {
  const Spline motion = testing::handheld_motion(4);
  std::vector<TrackedPose> poses = poses_of(motion);
  poses[300].status = TrackStatus::kLost;
  poses[300].world_from_camera = Rigid3();
  std::vector<Keyframe> keyframes = {keyframe_at(poses[200].world_from_camera)};
  std::vector<StampedCovariance> covariances = {{1, Matrix6::Identity()}};
  MountedImu imu;
  imu.samples = testing::imu_readings(motion, Rigid3(), {0.02, 0, 0}, {0, 0.05, 0});
  const InertialAlignment found = align_odometry(poses, keyframes, imu);
  ASSERT_EQ(found.status, Status::kOk);
  EXPECT_NEAR(found.scale, kScale, 0.005 * kScale);
  transform_to_metric_world(found, poses, keyframes, covariances);
  // Up to where the world's x axis points.
  for (const std::size_t i : {100U, 500U, 700U}) {
    const Rigid3 truth = motion.pose(0.005 * static_cast<double>(i));
    const Eigen::Vector3d place = poses[i].world_from_camera.translation();
    EXPECT_NEAR(place.norm(), truth.translation().norm(), 0.01);
    EXPECT_NEAR(place.z(), truth.translation().z(), 0.01);
  }
  EXPECT_NEAR(poses[0].position_sigma_m, 0.02, 1e-3);
  EXPECT_NEAR(covariances[0].covariance(0, 0), kScale * kScale, 0.05);
  EXPECT_NEAR(covariances[0].covariance(4, 4), 1, 1e-12);
  const Keyframe& keyframe = keyframes.front();
  EXPECT_NEAR(keyframe.typical_depth_m, kScale, 0.01);
  EXPECT_NEAR(keyframe.depth.points[0].inverse_depth, 0.5 / kScale, 0.002);
  const Eigen::Vector3d edge(keyframe.edges.x[0], keyframe.edges.y[0], keyframe.edges.z[0]);
  EXPECT_LT(
      (keyframe.world_from_camera.inverse() * edge - Eigen::Vector3d(0, 0, 2 * found.scale)).norm(),
      1e-4);
}

TEST(MetricWorld, SaysWhatTheReadingsShow) {
  const testing::TemporaryFolder folder;
  InertialAlignment found;
  found.status = Status::kUnobservableScale;
  write_inertial_alignment(folder.path() / "inertial.yaml", found, false);
  const std::string text = testing::read_file(folder.path() / "inertial.yaml");
  EXPECT_THAT(text, ::testing::HasSubstr("status: even_motion"));
  EXPECT_THAT(text, ::testing::HasSubstr("applied: false"));
}

TEST(MetricWorld, NeedsPoses) { EXPECT_EQ(align_odometry({}, {}, {}).status, Status::kNoSamples); }

}  // namespace
}  // namespace saccade
