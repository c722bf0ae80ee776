#include "estimator/depth/thesis/depth_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace saccade {
namespace {

double normal(double error, double variance) {
  return std::exp(-error * error / (2 * variance)) / std::sqrt(2 * std::numbers::pi * variance);
}

/// First two moments of depth z and inlier probability p under the exact posterior
///   (p N(x; z, tau^2) + (1 - p) / range) N(z; mu, s2) Beta(p; a, b),
/// by the midpoint rule.
struct Moments {
  double z = 0, zz = 0, p = 0, pp = 0;
};

Moments integrate(const DepthBelief& belief, double x, double variance, double range) {
  constexpr int kSteps = 800;
  const double sigma = std::sqrt(belief.variance);
  Moments m;
  double all = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = belief.mean + sigma * 16 * ((i + 0.5) / kSteps - 0.5);
    for (int j = 0; j < kSteps; ++j) {
      const double p = (j + 0.5) / kSteps;
      const double weight = (p * normal(x - z, variance) + (1 - p) / range) *
                            normal(z - belief.mean, belief.variance) * std::pow(p, belief.a - 1) *
                            std::pow(1 - p, belief.b - 1);
      all += weight;
      m.z += weight * z;
      m.zz += weight * z * z;
      m.p += weight * p;
      m.pp += weight * p * p;
    }
  }
  return {m.z / all, m.zz / all, m.p / all, m.pp / all};
}

TEST(DepthFilter, MatchesTheMomentsOfTheExactPosterior) {
  for (const auto& [belief, x, variance] : {std::tuple{DepthBelief{0.3, 0.04, 10, 10}, 0.35, 0.01},
                                            std::tuple{DepthBelief{0.3, 0.04, 10, 10}, 1.2, 0.01},
                                            std::tuple{DepthBelief{0.5, 0.01, 6, 3}, 0.48, 0.09}}) {
    const double range = 2;
    const Moments m = integrate(belief, x, variance, range);
    const DepthBelief next = updated(belief, x, variance, range);
    EXPECT_NEAR(next.mean, m.z, 1e-6);
    EXPECT_NEAR(next.variance, m.zz - m.z * m.z, 1e-6);
    const double n = next.a + next.b;
    EXPECT_NEAR(next.a / n, m.p, 1e-5);
    EXPECT_NEAR(next.a * (next.a + 1) / (n * (n + 1)), m.pp, 1e-5);
  }
}

/// Feeds measurements of which every one is an inlier with `inliers`, else uniform.
DepthBelief after(int count, double inliers, std::uint64_t seed) {
  constexpr double kTruth = 0.4, kTau = 0.05, kRange = 2;
  const Random random(seed);
  DepthBelief belief{0.8, 0.1};
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const double x = random.uniform(0, index) < inliers ? kTruth + kTau * random.normal(1, index)
                                                        : kRange * random.uniform(2, index);
    belief = updated(belief, x, kTau * kTau, kRange);
    EXPECT_GT(belief.variance, 0);
    EXPECT_GT(belief.a, 0);
    EXPECT_GT(belief.b, 0);
  }
  return belief;
}

TEST(DepthFilter, FindsTheDepthAmongOutliers) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DepthBelief belief = after(300, 0.6, seed);
    EXPECT_NEAR(belief.mean, 0.4, 5 * 0.05 / std::sqrt(0.6 * 300));
    EXPECT_NEAR(belief.inlier_probability(), 0.6, 0.12);
  }
}

TEST(DepthFilter, StatesItsOwnError) {
  // Of measurements that are all inliers sigma is tau / sqrt(n), and the squared error over
  // the variance averages 1.
  double chi2 = 0;
  constexpr int kRuns = 400;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const DepthBelief belief = after(40, 1, seed);
    chi2 += (belief.mean - 0.4) * (belief.mean - 0.4) / belief.variance;
  }
  EXPECT_NEAR(chi2 / kRuns, 1, 4 * std::sqrt(2.0 / kRuns));
}

TEST(DepthFilter, AMeasurementFarOffChangesLittleButTheOdds) {
  const DepthBelief before{0.4, 1e-6, 20, 5};
  const DepthBelief next = updated(before, 1.7, 1e-6, 2);
  EXPECT_NEAR(next.mean, before.mean, 1e-9);
  EXPECT_NEAR(next.variance, before.variance, 1e-12);
  EXPECT_LT(next.inlier_probability(), before.inlier_probability());
}

}  // namespace
}  // namespace saccade
