#include "estimator/depth/rays/ray_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace saccade {
namespace {

struct Truth {
  float change = 0.03F, offset = 0.4F, tilt = 0.1F, hysteresis = 0.2F;
};

/// Rays that all pass through one line, n . (x - e) = c + m s + h p, `noise_px` across it.
RayNeighbourhood rays_through(const Truth& truth, std::size_t count, double noise_px,
                              std::uint64_t stream) {
  const Random random(7);
  RayNeighbourhood near;
  near.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t k = 4 * i;
    near.event[i] = static_cast<std::uint32_t>(i);
    near.parallax[i] = static_cast<float>(50 * random.uniform(stream, k) - 25);
    near.along[i] = static_cast<float>(3 * random.uniform(stream, k + 1) - 1.5);
    near.polarity[i] = random.uniform(stream, k + 2) < 0.5 ? -1.F : 1.F;
    near.across[i] = truth.offset + truth.tilt * near.along[i] +
                     truth.hysteresis * near.polarity[i] - truth.change * near.parallax[i] +
                     static_cast<float>(noise_px * random.normal(stream, k + 3));
  }
  near.count = count;
  near.pad();
  return near;
}

/// Without priors, so that the solution is exact.
RegressionOptions exact_options() {
  RegressionOptions options;
  options.offset_sigma_px = 1e4;
  options.tilt_sigma = 1e4;
  options.hysteresis_sigma_px = 1e4;
  options.iterations = 8;
  return options;
}

TEST(RayRegression, RecoversAllFourUnknowns) {
  const Truth truth;
  const RegressionResult result = regress(rays_through(truth, 101, 0, 1), exact_options());
  ASSERT_TRUE(result.ok);
  EXPECT_NEAR(result.change, truth.change, 1e-4);
  EXPECT_NEAR(result.offset_px, truth.offset, 1e-3);
  EXPECT_NEAR(result.tilt, truth.tilt, 1e-3);
  EXPECT_NEAR(result.hysteresis_px, truth.hysteresis, 1e-3);
}

TEST(RayRegression, HysteresisIsWhereOnEventsLieAcrossTheEdge) {
  Truth truth;
  truth.hysteresis = 0.3F;
  EXPECT_GT(regress(rays_through(truth, 100, 0.05, 2), exact_options()).hysteresis_px, 0.2F);
  truth.hysteresis = -0.3F;
  EXPECT_LT(regress(rays_through(truth, 100, 0.05, 2), exact_options()).hysteresis_px, -0.2F);
}

TEST(RayRegression, WhatIsNotSoughtStaysZero) {
  RegressionOptions options = exact_options();
  options.offset_sigma_px = options.tilt_sigma = options.hysteresis_sigma_px = 0;
  const RegressionResult result = regress(rays_through({}, 200, 0.1, 3), options);
  ASSERT_TRUE(result.ok);
  EXPECT_EQ(result.offset_px, 0);
  EXPECT_EQ(result.tilt, 0);
  EXPECT_EQ(result.hysteresis_px, 0);
}

TEST(RayRegression, EventsOfOtherEdgesHaveNoSay) {
  const Truth truth;
  RayNeighbourhood near = rays_through(truth, 200, 0.1, 4);
  for (std::size_t i = 0; i < near.count; i += 4) {
    near.across[i] = static_cast<float>(4 * Random(8).uniform(0, i) - 2);
  }
  const RegressionResult result = regress(near, exact_options());
  ASSERT_TRUE(result.ok);
  EXPECT_NEAR(result.change, truth.change, 4 * result.sigma);
  EXPECT_NEAR(result.change, truth.change, 0.005);
}

/// How far the results of some regressions are from where they would end, in the median, in sigmas.
double way_left(const RegressionOptions& options) {
  std::vector<double> left;
  for (std::uint64_t trial = 0; trial < 101; ++trial) {
    RayNeighbourhood near = rays_through({}, 60, 0.25, 100 + trial);
    for (std::size_t i = 0; i < near.count; i += 3)
      near.across[i] = static_cast<float>(3 * Random(9).uniform(trial, i) - 1.5);
    RegressionOptions endless = options;
    endless.iterations = 200;
    endless.converged = 0;
    const RegressionResult end = regress(near, endless);
    left.push_back(
        std::abs(static_cast<double>((regress(near, options).change - end.change) / end.sigma)));
  }
  std::nth_element(left.begin(), left.begin() + 50, left.end());
  return left[50];
}

TEST(RayRegression, GoesOnUntilItHasConverged) {
  RegressionOptions options;
  options.iterations = 15;
  options.converged = 0.001;
  const double left = way_left(options);
  EXPECT_LT(left, 0.01);
  EXPECT_LT(3 * left, way_left({}));
}

TEST(RayRegression, SigmaIsTheDeviationOfTheResult) {
  const Truth truth;
  int within = 0;
  constexpr int kTrials = 400;
  for (int i = 0; i < kTrials; ++i) {
    const RegressionResult result = regress(
        rays_through(truth, 150, 0.3, 100 + static_cast<std::uint64_t>(i)), exact_options());
    if (std::abs(result.change - truth.change) <= result.sigma) ++within;
  }
  // 68 % of a Gaussian, 5 deviations of the count on either side; the biweight costs a little.
  EXPECT_GT(within, 0.55 * kTrials);
  EXPECT_LT(within, 0.78 * kTrials);
}

TEST(RayRegression, APriorHoldsTheDepthWhereTheRaysSayNothing) {
  constexpr double kPrior = 0.01;
  const Truth truth;
  // Little parallax: by themselves the rays find a depth far off, or none.
  RayNeighbourhood near = rays_through(truth, 100, 0.3, 9);
  for (std::size_t i = 0; i < near.count; ++i) {
    near.across[i] += truth.change * near.parallax[i] * 0.999F;
    near.parallax[i] *= 0.001F;
  }
  const RegressionResult free = regress(near, exact_options());
  const RegressionResult held = regress(near, exact_options(), kPrior);
  ASSERT_TRUE(held.ok);
  EXPECT_NEAR(held.sigma, kPrior, 0.1 * kPrior);
  EXPECT_LT(std::abs(held.change), kPrior);
  EXPECT_TRUE(!free.ok || free.sigma > 10 * kPrior);
  // With enough parallax it does not matter.
  EXPECT_NEAR(regress(rays_through(truth, 200, 0.1, 10), exact_options(), 1).change, truth.change,
              0.003);
}

TEST(RayRegression, OnlyEventsOfTheEdgeAreAppended) {
  const Truth truth;
  RayNeighbourhood near = rays_through(truth, 200, 0.05, 11);
  for (std::size_t i = 0; i < near.count; i += 5) near.across[i] += 1.5F;
  const RegressionResult result = regress(near, exact_options());
  EdgelEvents events;
  append_events(near, result, events);
  ASSERT_EQ(events.event.size(), events.weight.size());
  EXPECT_GT(events.event.size(), 140U);
  for (std::size_t i = 0; i < events.event.size(); ++i) {
    EXPECT_NE(events.event[i] % 5, 0U);
    EXPECT_GT(events.weight[i], 0);
    EXPECT_LE(events.weight[i], 1);
  }
}

TEST(RayRegression, NoParallaxOrTooFewEventsIsAStatus) {
  RayNeighbourhood near = rays_through({}, 100, 0.1, 5);
  for (std::size_t i = 0; i < near.count; ++i) near.parallax[i] = 0;
  EXPECT_FALSE(regress(near, exact_options()).ok);
  EXPECT_FALSE(regress(rays_through({}, 5, 0.1, 6), exact_options()).ok);
}

TEST(RayRegression, TheMovedEdgeIsTheLineThatWasFound) {
  const Edgel edge{{10, 20}, Eigen::Vector2f(0.6F, 0.8F), 0.5F};
  RegressionResult result;
  result.offset_px = 0.3F;
  result.tilt = 0.2F;
  result.change = 0.1F;
  const Edgel next = moved(edge, result);
  EXPECT_FLOAT_EQ(next.inverse_depth, 0.6F);
  // The points e + s t + (c + m s) n lie on it.
  for (const float s : {-2.F, 0.F, 2.F}) {
    const Eigen::Vector2f x =
        edge.pixel + s * edge.tangent() + (result.offset_px + result.tilt * s) * edge.normal;
    EXPECT_NEAR(next.normal.dot(x - next.pixel), 0, 1e-5);
  }
}

}  // namespace
}  // namespace saccade
