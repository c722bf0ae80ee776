#include "estimator/depth/still_windows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/rigid3.h"

namespace saccade {
namespace {

/// Ten windows of 0.1 s before a camera that moves as `pose_at` says, and what becomes of them.
class StillWindows : public ::testing::Test {
 protected:
  static constexpr double kDuration_s = 1;

  StillWindows() {
    for (int i = 0; i <= 1000; ++i) events_.push_back({i * TimeNs{1'000'000}, 0, 0, 1});
    demand_.camera = PinholeCamera{};
    demand_.camera.width = 200;
    demand_.camera.height = 100;
    demand_.camera.fx = demand_.camera.fy = 200;
    demand_.mean_depth_m = 2;
    demand_.least_px = 10;  // 0.1 m sideways
  }

  std::vector<ViewWindow> join(const std::function<Rigid3(double)>& pose_at) {
    std::vector<StampedPose> poses;
    for (int i = 0; i <= 1000; ++i) poses.push_back({0.001 * i, pose_at(0.001 * i)});
    trajectory_ = Trajectory(poses);
    const ViewWindowOptions options{.duration_s = 0.1, .reference = Reference::kMiddle};
    return join_still_windows(cut_windows(events_, trajectory_, options), demand_, options);
  }

  /// Numbers of base windows that the joined ones hold; they hold all events, each once.
  [[nodiscard]] std::vector<int> sizes(const std::vector<ViewWindow>& windows) const {
    std::vector<int> sizes;
    const Event* next = events_.data();
    for (const ViewWindow& window : windows) {
      EXPECT_EQ(window.events.data(), next);
      next += window.events.size();
      sizes.push_back(
          static_cast<int>(std::lround(static_cast<double>(window.events.size()) / 100)));
      const double from_s = seconds_from_ns(window.events.front().t_ns);
      const double to_s = seconds_from_ns(window.events.back().t_ns);
      EXPECT_NEAR(window.reference_s, (from_s + to_s) / 2, 1e-9);
    }
    EXPECT_EQ(next, events_.data() + events_.size());
    return sizes;
  }

  static Rigid3 at(const Eigen::Vector3d& position) {
    return {Eigen::Quaterniond::Identity(), position};
  }

  using Reference = ViewWindowOptions::Reference;
  using Sizes = std::vector<int>;
  Events events_;
  Trajectory trajectory_;
  ParallaxDemand demand_;
};

TEST_F(StillWindows, AFastCameraKeepsThem) {
  EXPECT_EQ(sizes(join([](double t_s) { return at({1.1 * t_s, 0, 0}); })), Sizes(10, 1));
}

TEST_F(StillWindows, ASlowCameraJoinsAsManyAsItNeeds) {
  // 0.06 m in a window, 0.12 m in two.
  EXPECT_EQ(sizes(join([](double t_s) { return at({0, 0.6 * t_s, 0}); })), Sizes(5, 2));
}

TEST_F(StillWindows, WhatTheLastOneLacksItTakesFromThoseBefore) {
  // 0.045 m in a window, 0.135 m in three: three times three, and one that joins the last of them.
  EXPECT_EQ(sizes(join([](double t_s) { return at({0.45 * t_s, 0, 0}); })), (Sizes{3, 3, 4}));
}

TEST_F(StillWindows, NotMoreThanFiveAreJoinedAtRest) {
  EXPECT_EQ(sizes(join([](double) { return at({0, 0, 0}); })), (Sizes{5, 5}));
}

TEST_F(StillWindows, AlongTheViewTheImageMovesLess) {
  // Points are 0.38 sqrt(200 x 100) = 54 px from the centre: 10 px of them are 0.37 m.
  EXPECT_EQ(sizes(join([](double t_s) { return at({0, 0, 1.0 * t_s}); })), (Sizes{4, 4, 2}));
}

TEST_F(StillWindows, AShakenCameraIsJudgedByItsWayAndNotByItsEnds) {
  const auto shaken = [](double amplitude_m) {
    return [=](double t_s) { return at({amplitude_m * std::sin(2 * M_PI * 10 * t_s), 0, 0}); };
  };
  EXPECT_EQ(sizes(join(shaken(0.051))), Sizes(10, 1));
  EXPECT_EQ(sizes(join(shaken(0.04))), (Sizes{5, 5}));
}

TEST_F(StillWindows, WhereTheCameraTurnsTheyAreNotJoined) {
  // Half of the lower field of view is 0.245 rad; three windows turn by 0.3.
  const auto turned = [](double t_s) {
    return Rigid3(so3_exp({0, 1.0 * t_s, 0}), Eigen::Vector3d(0.1 * t_s, 0, 0));
  };
  EXPECT_EQ(sizes(join(turned)), Sizes(5, 2));
}

TEST_F(StillWindows, ADemandOfNothingJoinsNone) {
  demand_.least_px = 0;
  EXPECT_EQ(sizes(join([](double) { return at({0, 0, 0}); })), Sizes(10, 1));
}

TEST_F(StillWindows, NoWindowsStayNone) {
  EXPECT_TRUE(join_still_windows({}, demand_, {}).empty());
}

}  // namespace
}  // namespace saccade
