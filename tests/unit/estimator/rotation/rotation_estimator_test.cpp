#include "estimator/rotation/rotation_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{120, 90, 100, 102, 59.5, 44.5, {-0.1, 0.02, 0, 0, 0}};

/// Events of points at infinity before a camera that turns evenly: one each time a point enters
/// another pixel.
Events turning(const Eigen::Vector3d& rate, double duration_s, int points = 150) {
  Events events;
  const Random random(7);
  constexpr int kSteps = 400;
  for (int k = 0; k < points; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const Eigen::Vector3d point(1.4 * random.uniform(0, i) - 0.7, 1.1 * random.uniform(1, i) - 0.55,
                                1);
    int x = -1, y = -1;
    for (int step = 0; step <= kSteps; ++step) {
      const double t_s = duration_s * step / kSteps;
      const Eigen::Vector3d seen = so3_exp(rate * (t_s - duration_s / 2)).conjugate() * point;
      const Eigen::Vector2d pixel = kCamera.distort(kCamera.project(seen));
      const auto u = static_cast<int>(std::lround(pixel.x()));
      const auto v = static_cast<int>(std::lround(pixel.y()));
      if (u == x && v == y) continue;
      x = u;
      y = v;
      if (u < 0 || v < 0 || u >= kCamera.width || v >= kCamera.height) continue;
      events.push_back(
          {ns_from_seconds(t_s), static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v), 1});
    }
  }
  std::sort(events.begin(), events.end(), EventOrder{});
  return events;
}

TEST(RotationContrast, GradientIsThatOfTheContrast) {
  RotationContrast contrast(kCamera, 1, 5000);
  contrast.load(turning({1.5, -2, 1}, 0.05));
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -1.5, 0.2), Eigen::Vector3d(2, -2.5, 2)}) {
    const auto value = contrast.evaluate(at);
    Eigen::Vector3d numeric;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 0.02 * Eigen::Vector3d::Unit(axis);
      numeric[axis] =
          (contrast.evaluate(at + step).contrast - contrast.evaluate(at - step).contrast) / 0.04;
    }
    // The bilinear image has kinks, and the turn is differentiated to first order.
    EXPECT_LT((value.gradient - numeric).norm(), 0.05 * numeric.norm()) << at.transpose();
  }
}

TEST(RotationContrast, IsLargestAtTheTrueRate) {
  const Eigen::Vector3d truth(1.5, -2, 1);
  RotationContrast contrast(kCamera, 1, 5000);
  contrast.load(turning(truth, 0.08));
  const double best = contrast.evaluate(truth).contrast;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      EXPECT_LT(contrast.evaluate(truth + sign * 0.5 * Eigen::Vector3d::Unit(axis)).contrast, best);
}

TEST(RotationEstimator, FindsTheRateFromEventsAlone) {
  RotationEstimator estimator(kCamera, {});
  for (const Eigen::Vector3d& truth :
       {Eigen::Vector3d(1.5, -2, 1), Eigen::Vector3d(-0.8, 0, 3), Eigen::Vector3d(0, 3, 0)}) {
    const Events events = turning(truth, 0.05);
    const RotationEstimate estimate = estimator.estimate(events, 0.7 * truth);
    EXPECT_TRUE(estimate.is_valid);
    EXPECT_NEAR(estimate.t_s, 0.025, 1e-3);
    EXPECT_LT((estimate.rate - truth).norm(), 0.03 * truth.norm()) << estimate.rate.transpose();
  }
}

TEST(RotationEstimator, TooFewEventsSayNothing) {
  RotationEstimator estimator(kCamera, {});
  const Events events(5, Event{1000, 3, 4, 1});
  const RotationEstimate estimate = estimator.estimate(events, {1, 2, 3});
  EXPECT_FALSE(estimate.is_valid);
  EXPECT_EQ(estimate.rate, Eigen::Vector3d(1, 2, 3));
}

TEST(RotationEstimator, ASlowWindowIsCut) {
  RotationOptions options;
  options.events = 100;
  options.max_window_s = 0.01;
  Events events;
  for (int i = 0; i < 1000; ++i) events.push_back({i * 1'000'000, 0, 0, 1});
  EXPECT_EQ(next_window(events, options), 10U);
  options.max_window_s = 1;
  EXPECT_EQ(next_window(events, options), 100U);
  EXPECT_EQ(next_window({}, options), 0U);
}

}  // namespace
}  // namespace saccade
