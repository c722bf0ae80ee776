#include "estimator/rotation/rotation_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/rigid3.h"

namespace saccade {
namespace {

const PinholeCamera kCamera{120, 90, 100, 102, 59.5, 44.5, {-0.1, 0.02, 0, 0, 0}};

/// Events of points at infinity before a camera that turns: one each time a point enters another
/// pixel.
Events turning(const AngularMotion& truth, double duration_s, int points = 150) {
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
      const double t = t_s - duration_s / 2;
      const Eigen::Vector3d angle = t * truth.rate + 0.5 * t * t * truth.acceleration;
      const Eigen::Vector3d seen = so3_exp(angle).conjugate() * point;
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

using Parameters = RotationContrast::Parameters;

TEST(RotationContrast, GradientIsThatOfTheContrast) {
  RotationContrast contrast(kCamera, 1, {0, 0}, 5000);
  contrast.load(turning({{1.5, -2, 1}, {20, -10, 30}}, 0.05));
  for (const AngularMotion& at : {AngularMotion{}, AngularMotion{{1, -1.5, 0.2}, {5, -30, 0}},
                                  AngularMotion{{2, -2.5, 2}, {0, 0, 60}}}) {
    Parameters at_motion;
    at_motion << at.rate, at.acceleration;
    const auto value = contrast.evaluate(at_motion);
    Parameters numeric;
    for (int axis = 0; axis < 6; ++axis) {
      // A move of 0.03 px.
      const double delta =
          0.03 / (axis < 3 ? contrast.px_per_rate() : contrast.px_per_acceleration());
      const Parameters step = delta * Parameters::Unit(axis);
      numeric[axis] = (contrast.evaluate(at_motion + step).contrast -
                       contrast.evaluate(at_motion - step).contrast) /
                      (2 * delta);
    }
    // The bilinear image has kinks, and the turn is differentiated to first order.
    EXPECT_LT((value.gradient - numeric).head<3>().norm(), 0.05 * numeric.head<3>().norm());
    EXPECT_LT((value.gradient - numeric).tail<3>().norm(), 0.1 * numeric.tail<3>().norm());
  }
}

TEST(RotationContrast, TheRateIsThatWhereTheEventsAre) {
  RotationContrast contrast(kCamera, 1, {0, 0}, 5000);
  Events events = turning({{1.5, -2, 1}, {20, -10, 30}}, 0.05);
  // Most events of the second half are missing.
  const auto middle = events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2);
  for (auto at = middle; at != events.end(); ++at)
    if ((at - middle) % 4 != 0) at->t_ns = -1;
  std::erase_if(events, [](const Event& event) { return event.t_ns < 0; });
  contrast.load(events);
  EXPECT_LT(contrast.reference_s(), contrast.middle_s() - 0.002);
  EXPECT_GT(contrast.reference_s(), seconds_from_ns(events[events.size() / 2].t_ns));
}

TEST(BurstFilter, APixelThatFiresOnAndOnIsNotOneBurst) {
  BurstFilter filter(kCamera, {.gap = 0.1, .longest = 0.1}, 1000);
  Events events;
  for (int i = 0; i <= 1000; ++i) events.push_back({i * 100'000, 60, 45, 1});
  // One event for each tenth of the 0.1 s, and the last of them at the end.
  EXPECT_EQ(filter.rays_of(events).t.size(), 11U);
  BurstFilter patient(kCamera, {.gap = 0.1, .longest = 1}, 1000);
  EXPECT_EQ(patient.rays_of(events).t.size(), 2U);
}

TEST(RotationContrast, IsLargestAtTheTrueMotion) {
  const AngularMotion truth{{1.5, -2, 1}, {20, -10, 30}};
  RotationContrast contrast(kCamera, 1, {0, 0}, 5000);
  contrast.load(turning(truth, 0.08));
  Parameters best;
  best << truth.rate, truth.acceleration;
  for (int axis = 0; axis < 6; ++axis)
    for (const double sign : {-1.0, 1.0})
      EXPECT_LT(
          contrast.evaluate(best + sign * (axis < 3 ? 0.5 : 30) * Parameters::Unit(axis)).contrast,
          contrast.evaluate(best).contrast)
          << axis;
}

RotationOptions few_events() {
  RotationOptions options;
  options.min_events = 100;
  return options;
}

TEST(RotationEstimator, FindsTheRateFromEventsAlone) {
  RotationEstimator estimator(kCamera, few_events());
  for (const Eigen::Vector3d& truth :
       {Eigen::Vector3d(1.5, -2, 1), Eigen::Vector3d(-0.8, 0, 3), Eigen::Vector3d(0, 3, 0)}) {
    const Events events = turning({truth, Eigen::Vector3d::Zero()}, 0.05);
    const RotationEstimate estimate =
        estimator.estimate(events, {0.7 * truth, Eigen::Vector3d::Zero()});
    EXPECT_TRUE(estimate.is_valid);
    EXPECT_NEAR(estimate.t_s, 0.025, 3e-3);  // all points fire at the start
    EXPECT_LT((estimate.turning.rate - truth).norm(), 0.03 * truth.norm())
        << estimate.turning.rate.transpose();
  }
}

TEST(RotationEstimator, FindsARateThatChanges) {
  RotationEstimator estimator(kCamera, few_events());
  const AngularMotion truth{{1, -2, 0.5}, {-60, 80, 40}};
  const RotationEstimate estimate = estimator.estimate(turning(truth, 0.05), {});
  const Eigen::Vector3d rate = truth.rate + (estimate.t_s - 0.025) * truth.acceleration;
  EXPECT_LT((estimate.turning.rate - rate).norm(), 0.25);
  EXPECT_LT((estimate.turning.acceleration - truth.acceleration).norm(), 20);
  const AngularMotion later = RotationEstimator::predict(estimate, 0.035);
  EXPECT_LT((later.rate - truth.rate - 0.01 * truth.acceleration).norm(), 0.4);
}

TEST(RotationEstimator, AGuessFarOffDoesNoHarm) {
  RotationEstimator estimator(kCamera, few_events());
  const AngularMotion truth{{1, -2, 0.5}, Eigen::Vector3d::Zero()};
  const RotationEstimate estimate =
      estimator.estimate(turning(truth, 0.05), {{900, 0, -700}, {1e5, 0, 0}});
  EXPECT_LT((estimate.turning.rate - truth.rate).norm(), 0.1);
}

TEST(RotationEstimator, TooFewEventsSayNothing) {
  RotationEstimator estimator(kCamera, {});
  const Events events(5, Event{1000, 3, 4, 1});
  const RotationEstimate estimate =
      estimator.estimate(events, {{1, 2, 3}, Eigen::Vector3d::Zero()});
  EXPECT_FALSE(estimate.is_valid);
  EXPECT_EQ(estimate.turning.rate, Eigen::Vector3d(1, 2, 3));
}

TEST(RotationEstimator, EventsOfOneMomentSayNothing) {
  RotationEstimator estimator(kCamera, few_events());
  const Events events(500, Event{1000, 3, 4, 1});
  EXPECT_FALSE(estimator.estimate(events, {}).is_valid);
}

TEST(RotationEstimator, ASlowWindowIsCut) {
  RotationOptions options;
  options.window_events = 100;
  Events events;
  for (int i = 0; i < 1000; ++i) events.push_back({i * 1'000'000, 0, 0, 1});
  EXPECT_EQ(next_window_size(events, 0.01, options), 10U);
  EXPECT_EQ(next_window_size(events, 1, options), 100U);
  EXPECT_EQ(next_window_size({}, 1, options), 0U);
  // Of what is left, no window is less than half of one.
  EXPECT_EQ(next_window_size(std::span(events).first(149), 1, options), 149U);
  EXPECT_EQ(next_window_size(std::span(events).first(150), 1, options), 100U);
  EXPECT_EQ(next_window_size(std::span(events).first(14), 0.01, options), 14U);
  EXPECT_EQ(next_window_size(std::span(events).first(17), 0.01, options), 10U);
}

TEST(RotationEstimator, AWindowIsAsLongAsItsMotionWants) {
  const RotationOptions options;
  // 100 px/s across the view, and as much about its axis at the RMS distance of 43 px from it.
  EXPECT_NEAR(window_duration(kCamera, {0, 1, 0}, options), 0.07, 1e-12);
  EXPECT_NEAR(window_duration(kCamera, {0, 0, 100 / std::sqrt(1875.0)}, options), 0.07, 1e-12);
  EXPECT_EQ(window_duration(kCamera, Eigen::Vector3d::Zero(), options), options.max_window_s);
  EXPECT_EQ(window_duration(kCamera, {10, 0, 0}, options), options.min_window_s);
}

TEST(RotationEstimator, WindowsBeginSqrtOfThreeFifthsApart) {
  Events events;
  for (int i = 0; i <= 1000; ++i) events.push_back({i * 1'000'000, 0, 0, 1});
  EXPECT_EQ(window_step(events), 775U);
  EXPECT_EQ(window_step(std::span(events).first(1)), 1U);
  EXPECT_EQ(window_step({}), 0U);
}

}  // namespace
}  // namespace saccade
