#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/median.h"
#include "core/process/parallel.h"
#include "core/time_search.h"
#include "estimator/depth/depth_config.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::PlanarWorld;
using testing::trajectory_of;

constexpr double kEnd_s = 0.3;

struct Recording {
  PlanarWorld world = corner_world(160, 120);
  Trajectory trajectory = trajectory_of(corner_glide, kEnd_s);
  Events events = world.simulate(corner_glide, 0, kEnd_s, 1e-3, 0.15);

  [[nodiscard]] ViewWindow window(double reference_s) const {
    return {events, &trajectory, reference_s};
  }
};

const Recording& recording() {
  static const Recording recording;
  return recording;
}

constexpr double kMeanDepth_m = 2.5;

/// What every method promises.
class EveryDepthMethod : public ::testing::TestWithParam<std::string_view> {
 protected:
  EveryDepthMethod() { config_.method = GetParam(); }
  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const {
    return make_depth_estimator(config_, recording().world.camera(), kMeanDepth_m)
        ->estimate(window);
  }
  /// Of the relative error: of its median, and of what 90 % stay below.
  struct Tolerance {
    double median, tail;
  };
  [[nodiscard]] static Tolerance tolerance() {
    if (GetParam() == DepthConfig::Method::kRays) return {0.003, 0.012};
    if (GetParam() == DepthConfig::Method::kSweep) return {0.05, 0.5};
    return {0.015, 0.06};
  }

  DepthConfig config_;
};

/// Relative errors against the best of the 3 x 3 pixels around each point.
std::vector<double> relative_errors(const DepthResult& result, double t_s) {
  const ImageF truth = recording().world.depth(corner_glide(t_s));
  std::vector<double> errors;
  for (const EdgePoint& point : result.points) {
    const auto x = static_cast<int>(std::lround(point.x_px));
    const auto y = static_cast<int>(std::lround(point.y_px));
    double best = 1e9;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, truth.height() - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, truth.width() - 1); ++u)
        if (truth(u, v) > 0)
          best = std::min(best, std::abs(1 / static_cast<double>(point.inverse_depth) /
                                             static_cast<double>(truth(u, v)) -
                                         1));
    errors.push_back(best);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST_P(EveryDepthMethod, RecoversTheDepthOfAKnownWorld) {
  for (const double t_s : {0.0, kEnd_s / 2, kEnd_s}) {
    const DepthResult result = estimate(recording().window(t_s));
    const std::vector<double> errors = relative_errors(result, t_s);
    ASSERT_GT(errors.size(), 300U) << t_s;
    EXPECT_LT(errors[errors.size() / 2], tolerance().median) << t_s;
    EXPECT_LT(errors[errors.size() * 9 / 10], tolerance().tail) << t_s;
    for (const EdgePoint& point : result.points) {
      EXPECT_GT(point.inverse_depth, 0);
      EXPECT_GT(point.sigma, 0);
    }
    EXPECT_GE(result.candidates.size(), result.points.size());
  }
}

TEST_P(EveryDepthMethod, DependsOnTheWindowAlone) {
  const auto estimator = make_depth_estimator(config_, recording().world.camera(), kMeanDepth_m);
  const DepthResult first = estimator->estimate(recording().window(0));
  static_cast<void>(estimator->estimate(recording().window(kEnd_s)));
  const DepthResult again = estimator->estimate(recording().window(0));
  ASSERT_EQ(first.points.size(), again.points.size());
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    EXPECT_EQ(first.points[i].x_px, again.points[i].x_px);
    EXPECT_EQ(first.points[i].inverse_depth, again.points[i].inverse_depth);
    EXPECT_EQ(first.points[i].sigma, again.points[i].sigma);
  }
}

TEST_P(EveryDepthMethod, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const DepthResult one = estimate(recording().window(kEnd_s / 2));
  set_thread_count(3);
  const DepthResult three = estimate(recording().window(kEnd_s / 2));
  set_thread_count(0);
  ASSERT_EQ(one.points.size(), three.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    EXPECT_EQ(one.points[i].x_px, three.points[i].x_px);
    EXPECT_EQ(one.points[i].inverse_depth, three.points[i].inverse_depth);
    EXPECT_EQ(one.points[i].sigma, three.points[i].sigma);
  }
}

TEST_P(EveryDepthMethod, TooFewEventsGiveNoPoints) {
  ViewWindow window = recording().window(0);
  window.events = {};
  EXPECT_TRUE(estimate(window).points.empty());
  window.events = std::span(recording().events).first(5);
  EXPECT_TRUE(estimate(window).points.empty());
}

TEST_P(EveryDepthMethod, PureRotationGivesNoPoints) {
  // The same events, but the poses claim that the camera only turned.
  const Trajectory turning = trajectory_of(
      [](double t_s) { return Rigid3(corner_glide(t_s).rotation(), Eigen::Vector3d::Zero()); },
      kEnd_s);
  ViewWindow window = recording().window(0);
  window.trajectory = &turning;
  EXPECT_TRUE(estimate(window).points.empty());
}

TEST_P(EveryDepthMethod, StatesTheSameStagesForEveryWindow) {
  const DepthResult full = estimate(recording().window(0));
  ViewWindow window = recording().window(0);
  window.events = {};
  const DepthResult none = estimate(window);
  ASSERT_EQ(full.stages_s.size(), none.stages_s.size());
  for (std::size_t i = 0; i < full.stages_s.size(); ++i)
    EXPECT_EQ(full.stages_s[i].first, none.stages_s[i].first);
}

std::string name_of(const ::testing::TestParamInfo<std::string_view>& method) {
  return std::string(method.param);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryDepthMethod, ::testing::ValuesIn(depth_method_names()),
                         name_of);

TEST(RayDepth, ForwardMotionServesAsWell) {
  const auto forward = [](double t_s) {
    return Rigid3(so3_exp({0.05 * t_s, 0, 0.2 * t_s}), {0.1 * t_s, 0, 1.2 * t_s});
  };
  const PlanarWorld& world = recording().world;
  const Events events = world.simulate(forward, 0, kEnd_s, 1e-3, 0.15);
  const Trajectory trajectory = trajectory_of(forward, kEnd_s);
  DepthConfig config;
  config.method = DepthConfig::Method::kRays;
  const DepthResult result = make_depth_estimator(config, world.camera(), kMeanDepth_m)
                                 ->estimate({events, &trajectory, kEnd_s / 2});
  const ImageF truth = world.depth(forward(kEnd_s / 2));
  std::vector<double> errors;
  for (const EdgePoint& point : result.points)
    errors.push_back(std::abs(1 / static_cast<double>(point.inverse_depth) /
                                  static_cast<double>(truth(static_cast<int>(point.x_px + 0.5F),
                                                            static_cast<int>(point.y_px + 0.5F))) -
                              1));
  std::sort(errors.begin(), errors.end());
  ASSERT_GT(errors.size(), 200U);
  EXPECT_LT(errors[errors.size() / 2], 0.01);
}

/// The first sixty milliseconds: four pixels of parallax from end to end.
ViewWindow short_window() {
  ViewWindow window = recording().window(0.03);
  window.events = window.events.first(count_before(recording().events, ns_from_seconds(0.06)));
  return window;
}

DepthConfig best_rays(int least_points) {
  DepthConfig config;
  config.method = DepthConfig::Method::kRays;
  config.rays.least_points = least_points;
  return config;
}

DepthResult by_rays(const ViewWindow& window, int least_points) {
  return make_depth_estimator(best_rays(least_points), recording().world.camera(), kMeanDepth_m)
      ->estimate(window);
}

TEST(RayDepth, OpensItsGatesWhereTheMotionTellsLittle) {
  const DepthResult strict = by_rays(short_window(), 0);
  const DepthResult opened = by_rays(short_window(), 200);
  EXPECT_EQ(strict.gate_opening, 1);
  EXPECT_GT(opened.gate_opening, 1);
  ASSERT_GT(opened.points.size(), 100 + 2 * strict.points.size());
  const std::vector<double> errors = relative_errors(opened, 0.03);
  EXPECT_LT(errors[errors.size() / 2], 0.1);
  // A view that has its points keeps its gates.
  EXPECT_EQ(by_rays(recording().window(kEnd_s / 2), 200).gate_opening, 1);
}

/// Errors in the middle of the recording, in ascending order, with some of the options for given poses.
std::vector<double> errors_with(bool fills, bool widens, int threads = 0) {
  DepthConfig config = best_rays(0);
  config.rays.refiner.until_converged = true;
  config.rays.fills = fills;
  config.rays.fusion.widens = widens;
  set_thread_count(threads);
  const DepthResult result = make_depth_estimator(config, recording().world.camera(), kMeanDepth_m)
                                 ->estimate(recording().window(kEnd_s / 2));
  set_thread_count(0);
  return relative_errors(result, kEnd_s / 2);
}

TEST(RayDepth, SeedsAmongTheirNeighboursGiveMoreAndNoWorsePoints) {
  const std::vector<double> without = errors_with(false, true), with = errors_with(true, true);
  EXPECT_GT(with.size(), without.size() + without.size() / 20);
  EXPECT_LE(with[with.size() / 2], 1.05 * without[without.size() / 2]);
  EXPECT_LE(with[with.size() * 9 / 10], 1.1 * without[without.size() * 9 / 10]);
}

TEST(RayDepth, WidenedPlanesGiveMoreAndNoWorsePoints) {
  const std::vector<double> without = errors_with(true, false), with = errors_with(true, true);
  EXPECT_GT(with.size(), without.size());
  EXPECT_LE(with[with.size() / 2], 1.1 * without[without.size() / 2]);
}

TEST(RayDepth, GivenPosesGiveTheSamePointsForAnyNumberOfThreads) {
  EXPECT_EQ(errors_with(true, true, 1), errors_with(true, true, 3));
}

TEST(RayDepth, NamesTheGateThatEmptiesAView) {
  const Trajectory turning = trajectory_of(
      [](double t_s) { return Rigid3(corner_glide(t_s).rotation(), Eigen::Vector3d::Zero()); },
      kEnd_s);
  ViewWindow window = recording().window(0);
  window.trajectory = &turning;
  EXPECT_THAT(by_rays(window, 200).why_empty, ::testing::HasSubstr("hardly translates"));
  window.events = window.events.first(5);
  EXPECT_THAT(by_rays(window, 200).why_empty, ::testing::HasSubstr("events"));
  EXPECT_EQ(by_rays(recording().window(0), 200).why_empty, "");
}

TEST(RayDepth, NoiseOfThePosesIsPartOfSigma) {
  const ViewWindow exact = recording().window(kEnd_s / 2);
  ViewWindow noisy = exact;
  noisy.pose_noise = {.rotation_rad = 2e-3, .position_m = 0, .spacing_s = 5e-3};
  const auto median_sigma = [](const DepthResult& result) {
    std::vector<double> sigmas;
    for (const EdgePoint& point : result.points)
      sigmas.push_back(static_cast<double>(point.sigma / point.inverse_depth));
    return median(std::move(sigmas));
  };
  // Sixty poses leave 2 mrad / sqrt(60), 0.034 px of 36 px from end to end, which scatter by 10 px.
  const double added = median_sigma(by_rays(noisy, 0)) - median_sigma(by_rays(exact, 0));
  EXPECT_GT(added, 0.001);
  EXPECT_LT(added, 0.02);
}

TEST(ThesisDepth, StartsAtTheStatedDepth) {
  // Far from the truth at the start, it still arrives.
  DepthConfig config;
  config.thesis.initial_depth_m = 12;
  const auto estimator = make_depth_estimator(config, recording().world.camera(), kMeanDepth_m);
  const auto errors = relative_errors(estimator->estimate(recording().window(0)), 0);
  ASSERT_GT(errors.size(), 300U);
  EXPECT_LT(errors[errors.size() / 2], 0.015);
}

}  // namespace
}  // namespace saccade
