#include "estimator/tracking/frames/frame_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

constexpr double kPeriod_s = 0.04;

const PlanarWorld& world() {
  static const PlanarWorld world = corner_world(160, 120);
  return world;
}

const IntensityMap& intensity_map() {
  static const std::vector<ReferenceView> views{
      {world().log_intensity(corner_motion(0)), world().depth(corner_motion(0)), corner_motion(0)}};
  static const IntensityMap map(world().camera(), views, 0);
  return map;
}

GreyFrame frame_at(double t_s) {
  return {ns_from_seconds(t_s), world().log_intensity(corner_motion(t_s))};
}

std::vector<GreyFrame> grey_frames(double period_s = kPeriod_s) {
  std::vector<GreyFrame> frames;
  for (int k = 0; k * period_s <= 0.2; ++k) frames.push_back(frame_at(k * period_s));
  return frames;
}

std::vector<TrackedPose> track(const std::vector<GreyFrame>& frames) {
  MotionModelOptions motion;
  motion.prediction = MotionModelOptions::Prediction::kConstantVelocity;
  FrameTracker tracker(motion, intensity_map());
  tracker.reset(0, corner_motion(0));
  return tracker.track({.frames = frames});
}

/// RMS distance of what the first view shows between two poses [px].
double distance_px(const Rigid3& a, const Rigid3& b) {
  double squared = 0;
  double count = 0;
  const auto& view = intensity_map().views().front();
  for (std::size_t i = 0; i < view.points.size(); i += 37) {
    if (!(view.inverse_depth[i] > 0)) continue;
    const Eigen::Vector3d point = intensity_map().world_from_map() * view.points[i].cast<double>();
    const Eigen::Vector2d u = world().camera().project(a.inverse() * point);
    squared += (u - world().camera().project(b.inverse() * point)).squaredNorm();
    ++count;
  }
  return std::sqrt(squared / count);
}

double frame_error_px(const TrackedPose& pose) {
  return distance_px(pose.world_from_camera, corner_motion(seconds_from_ns(pose.t_ns)));
}

double worst_px(const std::vector<TrackedPose>& poses) {
  double worst = 0;
  for (const TrackedPose& pose : poses) worst = std::max(worst, frame_error_px(pose));
  return worst;
}

bool any_lost(const std::vector<TrackedPose>& poses) {
  return std::any_of(poses.begin(), poses.end(),
                     [](const TrackedPose& p) { return p.status == TrackStatus::kLost; });
}

TEST(FrameTracker, EveryFrameGivesItsPose) {
  const std::vector<GreyFrame> frames = grey_frames();
  const std::vector<TrackedPose> poses = track(frames);
  ASSERT_EQ(poses.size(), frames.size());
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].t_ns, frames[i].t_ns);
  EXPECT_FALSE(any_lost(poses));
  EXPECT_LT(worst_px(poses), 0.1);
}

TEST(FrameTracker, LargeDisplacementsAreFoundCoarseToFine) {
  const std::vector<GreyFrame> frames{frame_at(0.1)};
  ASSERT_GT(distance_px(corner_motion(0), corner_motion(0.1)), 12);
  EXPECT_LT(worst_px(track(frames)), 0.1);
}

TEST(FrameTracker, PixelsOutsideTheRangeAreIgnored) {
  std::vector<GreyFrame> frames = grey_frames();
  for (GreyFrame& frame : frames)
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 80; ++x) frame.log_intensity(x, y) = kUnknownLogIntensity;
  const std::vector<TrackedPose> poses = track(frames);
  EXPECT_FALSE(any_lost(poses));
  EXPECT_LT(worst_px(poses), 0.3);
}

TEST(FrameTracker, SaysThatItIsLost) {
  std::vector<GreyFrame> frames = grey_frames();
  frames[2].log_intensity.fill(kUnknownLogIntensity);
  frames[4].log_intensity = world().log_intensity(Rigid3(so3_exp({0, 1.0, 0}), {0, 0, 0}));
  const std::vector<TrackedPose> poses = track(frames);
  EXPECT_EQ(poses[1].status, TrackStatus::kOk);
  EXPECT_EQ(poses[2].status, TrackStatus::kLost);
  EXPECT_EQ(poses[3].status, TrackStatus::kOk) << "what was predicted is near enough";
  EXPECT_LT(frame_error_px(poses[3]), 0.1);
  EXPECT_EQ(poses[4].status, TrackStatus::kLost);
}

TEST(FrameTracker, StartsAnewAfterAReset) {
  FrameTracker tracker({}, intensity_map());
  const std::vector<GreyFrame> frames = grey_frames();
  tracker.reset(0, corner_motion(0));
  const std::vector<TrackedPose> once = tracker.track({.frames = frames});
  tracker.reset(0, corner_motion(0));
  const std::vector<TrackedPose> again = tracker.track({.frames = frames});
  for (std::size_t i = 0; i < once.size(); ++i)
    EXPECT_EQ(once[i].world_from_camera.translation(), again[i].world_from_camera.translation());
}

}  // namespace
}  // namespace saccade
