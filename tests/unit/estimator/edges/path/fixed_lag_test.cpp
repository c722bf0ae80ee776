#include "estimator/edges/path/fixed_lag.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/time_search.h"
#include "estimator/depth/depth_config.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::kCornerDepth_m;

constexpr double kLagEnd_s = 0.4;
constexpr double kHeldUntil_s = 0.15;

Trajectory drifting_path() {
  std::vector<StampedPose> poses;
  for (double t_s = 0; t_s <= kLagEnd_s + 1e-9; t_s += 2e-3)
    poses.push_back({t_s, testing::drifting_glide(t_s, kHeldUntil_s, kLagEnd_s)});
  return Trajectory(std::move(poses));
}

class FixedLag : public ::testing::Test {
 protected:
  static const testing::PlanarWorld& world() {
    static const testing::PlanarWorld world = corner_world(160, 120);
    return world;
  }

  /// A smoother with the views at these times, of a window of 0.3 s each on the drifted path.
  FixedLagSmoother smoother(double lag_s, std::initializer_list<double> times_s) const {
    FixedLagOptions options;
    options.lag_s = lag_s;
    options.problem.edges = 300;
    options.problem.iterations = 10;
    FixedLagSmoother smoother(options, world().camera());
    for (const double t_s : times_s) smoother.add(view(smoother, path_, t_s), kHeldUntil_s);
    return smoother;
  }

  /// Of a window of 0.3 s around `t_s` that begins no earlier than the recording.
  static EdgeView view(const FixedLagSmoother& smoother, const Trajectory& path, double t_s) {
    static const Events events = world().simulate(corner_glide, 0, kLagEnd_s, 1e-3, 0.15);
    const DepthConfig config;
    const RayDepth depth(config.rays, config.limits, world().camera());
    const ViewWindow window{
        events_between(events, ns_from_seconds(t_s - 0.15), ns_from_seconds(t_s + 0.15)), &path,
        t_s};
    return smoother.view(window, depth.find_edgels(window), kHeldUntil_s);
  }

  static double error_m(const Trajectory& path, double t_s) {
    return (corner_glide(t_s).inverse() * path.at_clamped(t_s)).translation().norm();
  }

  Trajectory path_ = drifting_path();
};

TEST_F(FixedLag, CorrectsADriftingPath) {
  const auto smoothed = smoother(1, {0.1, 0.2, 0.3}).smooth(path_, kHeldUntil_s, kCornerDepth_m);
  ASSERT_TRUE(smoothed);
  EXPECT_EQ(smoothed->size(), path_.size());
  for (const double t_s : {0.25, 0.3, 0.35, 0.38})
    EXPECT_LT(error_m(*smoothed, t_s), 0.4 * error_m(path_, t_s)) << t_s;
}

TEST_F(FixedLag, HeldPosesStayAsTheyAre) {
  const auto smoothed = smoother(1, {0.1, 0.2, 0.3}).smooth(path_, kHeldUntil_s, kCornerDepth_m);
  ASSERT_TRUE(smoothed);
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const StampedPose& before = path_.poses()[i];
    const StampedPose& after = smoothed->poses()[i];
    EXPECT_EQ(before.world_from_camera.translation() == after.world_from_camera.translation(),
              before.t_s <= kHeldUntil_s)
        << before.t_s;
  }
}

TEST_F(FixedLag, WhatIsOlderThanTheLagIsNoLongerPartOfIt) {
  const auto smoothed = smoother(0.1, {0.1, 0.2, 0.28}).smooth(path_, kHeldUntil_s, kCornerDepth_m);
  ASSERT_TRUE(smoothed);
  EXPECT_GT(smoothed->start_s(), 0.02) << "the view at 0.1 s, of events from 0 s on, is forgotten";
  EXPECT_LT(smoothed->start_s(), 0.1);
  EXPECT_EQ(smoothed->end_s(), path_.end_s());
}

TEST_F(FixedLag, ViewsThatAreNotAdjustedAnyMoreStillCount) {
  // The first view is adjusted until the second one is there, and so on.
  FixedLagOptions options;
  options.lag_s = 1;
  options.fresh_s = 0.05;
  options.problem.edges = 300;
  FixedLagSmoother smoother(options, world().camera());
  Trajectory path = path_;
  for (const double t_s : {0.1, 0.2, 0.3}) {
    smoother.add(view(smoother, path, t_s), kHeldUntil_s);
    const auto smoothed = smoother.smooth(path, kHeldUntil_s, kCornerDepth_m);
    ASSERT_TRUE(smoothed);
    path = *smoothed;
  }
  // Of the last view's window half is after what the others have seen.
  for (const double t_s : {0.25, 0.3, 0.35, 0.38})
    EXPECT_LT(error_m(path, t_s), 0.5 * error_m(path_, t_s)) << t_s;
}

TEST_F(FixedLag, ALongerWindowOfTheSameBeginningReplacesAView) {
  FixedLagOptions options;
  options.lag_s = 1;
  options.problem.edges = 300;
  options.problem.iterations = 10;
  FixedLagSmoother once(options, world().camera()), again(options, world().camera());
  again.add(view(again, path_, 0.1), kHeldUntil_s);
  for (FixedLagSmoother* smoother : {&once, &again})
    smoother->add(view(*smoother, path_, 0.14), kHeldUntil_s);
  const auto first = once.smooth(path_, kHeldUntil_s, kCornerDepth_m);
  const auto second = again.smooth(path_, kHeldUntil_s, kCornerDepth_m);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->poses().back().world_from_camera.translation(),
            second->poses().back().world_from_camera.translation());
}

TEST_F(FixedLag, LandmarksTellWhereThePathIs) {
  // The whole path lies 10 mm beside the truth, 0.6 px, which its own edges do not tell.
  const Rigid3 aside(Eigen::Quaterniond::Identity(), {0.01, 0, 0});
  std::vector<StampedPose> truth, poses;
  for (double t_s = 0; t_s <= kLagEnd_s + 1e-9; t_s += 2e-3) {
    truth.push_back({t_s, corner_glide(t_s)});
    poses.push_back({t_s, aside * corner_glide(t_s)});
  }
  const Trajectory path(poses);
  FixedLagOptions options;
  options.lag_s = 1;
  options.problem.edges = 300;
  options.problem.iterations = 10;
  FixedLagSmoother smoother(options, world().camera()), without(options, world().camera());
  std::vector<Landmark> landmarks;
  for (const FittedEdgel& fitted : view(smoother, Trajectory(truth), 0.15).edges) {
    const auto rho = static_cast<double>(fitted.edge.inverse_depth);
    landmarks.push_back(
        {corner_glide(0.15) * (world().camera().ray(fitted.edge.pixel.cast<double>()) / rho),
         static_cast<double>(fitted.sigma) / rho});
  }
  constexpr double kNoneHeld_s = -1;
  for (FixedLagSmoother* each : {&smoother, &without})
    each->add(view(*each, path, 0.15), kNoneHeld_s);
  const auto found = smoother.smooth(path, kNoneHeld_s, kCornerDepth_m, landmarks);
  const auto lost = without.smooth(path, kNoneHeld_s, kCornerDepth_m);
  ASSERT_TRUE(found && lost);
  for (const double t_s : {0.1, 0.15, 0.25}) {
    EXPECT_LT(error_m(*found, t_s), 0.003) << t_s;
    EXPECT_GT(error_m(*lost, t_s), 0.007) << t_s;
  }
}

TEST_F(FixedLag, WithoutAViewThereIsNothingToAdjustBy) {
  FixedLagSmoother none = smoother(1, {0.1, 0.2});
  none.clear();
  EXPECT_FALSE(none.smooth(path_, kHeldUntil_s, kCornerDepth_m));
  EXPECT_TRUE(smoother(1, {0.2}).smooth(path_, kHeldUntil_s, kCornerDepth_m));
  EXPECT_FALSE(FixedLagSmoother({}, world().camera()).is_enabled());
}

}  // namespace
}  // namespace saccade
