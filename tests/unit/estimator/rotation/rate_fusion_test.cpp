#include "estimator/rotation/rate_fusion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

constexpr int kWindows = 1000;
constexpr double kLength_s = 0.01;
const Eigen::Vector3d kBias(0.05, -0.03, 0.08);

struct World {
  double density = 1e-3;
  double events_px = 0.04;
  double px_per_rate = 0.6;

  [[nodiscard]] static Eigen::Vector3d rate(int i) {
    return {5 * std::sin(0.3 * i), 3 * std::cos(0.17 * i), std::sin(0.05 * i)};
  }
  [[nodiscard]] RateMeasurements measured(int i) const {
    const Random random(3);
    const auto normal = [&](std::uint64_t stream) {
      const auto k = static_cast<std::uint64_t>(i);
      return Eigen::Vector3d(random.normal(stream, k), random.normal(stream + 1, k),
                             random.normal(stream + 2, k));
    };
    RateMeasurements measured;
    measured.t_s = kLength_s * i;
    measured.averaged_s = kLength_s;
    measured.px_per_rate = px_per_rate;
    measured.gyroscope = rate(i) + kBias + density / std::sqrt(kLength_s) * normal(0);
    measured.events = rate(i) + events_px / px_per_rate * normal(3);
    return measured;
  }
};

struct Errors {
  double fused = 0, gyroscope = 0, events = 0;  ///< RMS over the axes [rad/s]
};

/// Over the second half, against the gyroscope without the true bias.
Errors run(RateFusion& fusion, const World& world) {
  Errors squares;
  for (int i = 0; i < kWindows; ++i) {
    const RateMeasurements measured = world.measured(i);
    const Eigen::Vector3d rate = fusion.fuse(measured);
    if (i < kWindows / 2) continue;
    squares.fused += (rate - World::rate(i)).squaredNorm();
    squares.gyroscope += (measured.gyroscope - kBias - World::rate(i)).squaredNorm();
    squares.events += (measured.events - World::rate(i)).squaredNorm();
  }
  const auto rms = [](double sum) { return std::sqrt(sum / (1.5 * kWindows)); };
  return {rms(squares.fused), rms(squares.gyroscope), rms(squares.events)};
}

TEST(RateFusion, IsBetterThanEitherByTheirVariances) {
  const World world{.density = 4e-3, .events_px = 0.03};
  RateFusion fusion(GyroscopeNoise{.density = world.density});
  const Errors errors = run(fusion, world);
  const double best = 1 / std::sqrt(1 / (errors.gyroscope * errors.gyroscope) +
                                    1 / (errors.events * errors.events));
  EXPECT_LT(errors.fused, 1.05 * best);
}

TEST(RateFusion, FindsTheBiasAsWellAsItSays) {
  RateFusion fusion;
  run(fusion, {});
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(std::abs(fusion.bias()[k] - kBias[k]), 4 * fusion.bias_sigma()[k]);
  EXPECT_LT(fusion.bias_sigma().maxCoeff(), 0.004);
}

TEST(RateFusion, LearnsTheErrorOfTheEvents) {
  RateFusion fusion;
  run(fusion, {.events_px = 0.2});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(fusion.events_sigma_px()[k], 0.2, 0.05);
}

TEST(RateFusion, LeavesOutliersOut) {
  RateFusion fusion;
  const World world;
  run(fusion, world);
  RateMeasurements measured = world.measured(kWindows);
  measured.events.x() += 10;
  const Eigen::Vector3d bias = fusion.bias();
  const Eigen::Vector3d rate = fusion.fuse(measured);
  EXPECT_EQ(fusion.bias().x(), bias.x());
  EXPECT_EQ(rate.x(), measured.gyroscope.x() - bias.x());
  EXPECT_EQ(fusion.without_events(measured.gyroscope), measured.gyroscope - fusion.bias());
}

}  // namespace
}  // namespace saccade
