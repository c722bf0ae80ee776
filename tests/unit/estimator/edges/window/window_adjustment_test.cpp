#include "estimator/edges/window/window_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/depth/depth_config.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::kCornerDepth_m;
using testing::PlanarWorld;
using testing::trajectory_of;

constexpr double kAdjustedEnd_s = 0.3;
constexpr double kKnown_s = 0.15;

/// corner_glide(), drifting away after kKnown_s.
Rigid3 drifted(double t_s, double share) {
  const double away = share * std::max(0.0, t_s - kKnown_s) / (kAdjustedEnd_s - kKnown_s);
  return corner_glide(t_s) *
         Rigid3::exp(away * (Twist() << 0.01, -0.008, 0.012, 0.002, 0.003, -0.004).finished());
}

struct KeyframeRecording {
  PlanarWorld world = corner_world(160, 120);
  Events events = world.simulate(corner_glide, 0, kAdjustedEnd_s, 1e-3, 0.15);
};

const KeyframeRecording& keyframe_recording() {
  static const KeyframeRecording recording;
  return recording;
}

/// How far the picture of a scene at the typical depth is off, root mean square [px]: what events
/// tell. A step and the turn that looks like it are told apart by much less.
double error_px(const Trajectory& trajectory, double t_s) {
  const PinholeCamera& camera = keyframe_recording().world.camera();
  const Rigid3 found_from_true = trajectory.at_clamped(t_s).inverse() * corner_glide(t_s);
  double squared = 0, count = 0;
  for (int x = 0; x < camera.width; x += 20)
    for (int y = 0; y < camera.height; y += 20, ++count) {
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector3d point = kCornerDepth_m * camera.ray(pixel);
      squared += (camera.project(found_from_true * point) - pixel).squaredNorm();
    }
  return std::sqrt(squared / count);
}

/// `given_until_s`: the poses until kKnown_s are given, or, kNoGivenPoses, known from before.
WindowAdjustment adjusted(const Trajectory& start, double given_until_s = kKnown_s) {
  const ViewWindow window{keyframe_recording().events, &start, 0.15};
  const DepthConfig config;
  const RayDepth depth(config.rays, config.limits, keyframe_recording().world.camera());
  WindowAdjustmentOptions options;
  // All: of some hundred, chance in which are chosen moves the result by a third.
  options.edges = 3000;
  options.node_spacing_s = 0.02;
  options.given_pairs = 5;
  return adjust_window(window, depth.find_edgels(window), keyframe_recording().world.camera(),
                       {kKnown_s, given_until_s, kCornerDepth_m, {}}, options);
}

/// From the true path.
const WindowAdjustment& from_truth() {
  static const WindowAdjustment result = adjusted(trajectory_of(corner_glide, kAdjustedEnd_s));
  return result;
}

TEST(EdgeAdjustment, LeavesTheTruthWhereItIs) {
  const WindowAdjustment& result = from_truth();
  ASSERT_TRUE(result.ok);
  // Events scatter by a third of a pixel.
  for (const double t_s : {0.05, 0.15, 0.25, 0.3})
    EXPECT_LT(error_px(result.trajectory, t_s), 0.2) << t_s;
}

// A residual in the view instead of on the sensor would be made small by motion towards the scene.
TEST(EdgeAdjustment, DoesNotShrinkThePicture) {
  const WindowAdjustment& result = from_truth();
  ASSERT_TRUE(result.ok);
  const Rigid3 error =
      corner_glide(kAdjustedEnd_s).inverse() * result.trajectory.at_clamped(kAdjustedEnd_s);
  EXPECT_LT(std::abs(error.translation().z()), 1e-3 * kCornerDepth_m);
}

TEST(EdgeAdjustment, TooFewEdgesChangeNothing) {
  const Trajectory start = trajectory_of(corner_glide, kAdjustedEnd_s);
  const ViewWindow window{keyframe_recording().events, &start, 0.15};
  const WindowAdjustment result = adjust_window(window, {}, keyframe_recording().world.camera(),
                                                {kKnown_s, kNoGivenPoses, kCornerDepth_m, {}}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.trajectory.size(), start.size());
}

/// Median error of the edges' depths in a view, relative.
double median_depth_error(const WindowEdgels& found, const ImageF& depth) {
  std::vector<double> errors;
  for (const FittedEdgel& fitted : found.edges) {
    const auto x = static_cast<int>(std::lround(fitted.edge.pixel.x()));
    const auto y = static_cast<int>(std::lround(fitted.edge.pixel.y()));
    if (x < 0 || y < 0 || x >= depth.width() || y >= depth.height() || !(depth(x, y) > 0)) continue;
    errors.push_back(
        std::abs(1 / static_cast<double>(fitted.edge.inverse_depth * depth(x, y)) - 1));
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(EdgeAdjustment, EdgesThatWereFoundOnADriftingPathFitABetterOne) {
  const KeyframeRecording& recording = keyframe_recording();
  const PinholeCamera& camera = recording.world.camera();
  const Trajectory wrong =
      trajectory_of([](double t_s) { return drifted(t_s, 3); }, kAdjustedEnd_s);
  const Trajectory right = trajectory_of(corner_glide, kAdjustedEnd_s);
  const DepthConfig config;
  const ViewWindow on_wrong{recording.events, &wrong, 0.15},
      on_right{recording.events, &right, 0.15};
  const WindowEdgels found = RayDepth(config.rays, config.limits, camera).find_edgels(on_wrong);
  const WindowEdgels fitted =
      edges_on_path(on_right, found, camera, {kKnown_s, kKnown_s, kCornerDepth_m, {}}, {});
  EXPECT_GT(fitted.edges.size(), found.edges.size() * 9 / 10);
  const ImageF depth = recording.world.depth(corner_glide(0.15));
  EXPECT_LT(median_depth_error(fitted, depth), 0.5 * median_depth_error(found, depth));
}

TEST(EdgeAdjustment, BringsADriftingPathBack) {
  const Trajectory start =
      trajectory_of([](double t_s) { return drifted(t_s, 1); }, kAdjustedEnd_s);
  for (const double given_until_s : {kKnown_s, kNoGivenPoses}) {
    const WindowAdjustment first = adjusted(start, given_until_s);
    ASSERT_TRUE(first.ok);
    EXPECT_LT(first.residual_after_px, first.residual_before_px);
    // Better poses find better edges, but those that agree with the path they are sought along are
    // found first: of the drift some stays.
    const WindowAdjustment result = adjusted(first.trajectory, given_until_s);
    ASSERT_TRUE(result.ok);
    EXPECT_LT(error_px(result.trajectory, kAdjustedEnd_s), error_px(start, kAdjustedEnd_s) / 3)
        << given_until_s;
  }
}

}  // namespace
}  // namespace saccade
