#include "estimator/imu/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/rigid3.h"
#include "estimator/imu/complementary_filter.h"
#include "tests/unit/estimator/imu/imu_motion.h"

namespace saccade {
namespace {

using testing::hand_motion;
using testing::ImuErrors;
using testing::kDegree;
using testing::kReading_s;
using testing::kUp;
using testing::reading;
using testing::tilt_error;
using testing::with_biases;

InertialFilter slow_filter() {
  return InertialFilter({.velocity_sigma = 0.5},
                        {.density = 1e-4, .random_walk = 1e-6, .bias_sigma = 0.005});
}

TEST(InertialFilter, TellsGravityFromAccelerationInMotion) {
  InertialFilter filter = slow_filter();
  ComplementaryFilter complementary({});
  double squares = 0, complementary_squares = 0, count = 0;
  for (int i = 0; i <= 30000; ++i) {
    const ImuSample sample = reading(hand_motion(), i, 1, {});
    filter.update(sample);
    complementary.update(sample);
    if (i < 15000) continue;
    squares += std::pow(tilt_error(hand_motion(), filter.world_from_imu(), i * kReading_s), 2);
    complementary_squares +=
        std::pow(tilt_error(hand_motion(), complementary.world_from_imu(), i * kReading_s), 2);
    ++count;
  }
  const double error = std::sqrt(squares / count);
  EXPECT_LT(error, 0.5 * kDegree);
  EXPECT_LT(error, 0.2 * std::sqrt(complementary_squares / count));
  // Most of the bias has been found without a rest; nothing tells the part along the vertical.
  const auto horizontal = [&](const Eigen::Vector3d& rate) {
    return (filter.world_from_imu() * rate).head<2>().norm();
  };
  EXPECT_LT(horizontal(filter.bias() - ImuErrors{}.rate_bias),
            0.4 * horizontal(ImuErrors{}.rate_bias));
}

TEST(InertialFilter, ItsErrorsAreAsLargeAsItSays) {
  // One component of the tilt and the biases, over runs that differ in noise and biases.
  constexpr int kRuns = 40;
  double tilt = 0, bias = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<std::uint64_t>(run + 1);
    const ImuErrors errors = with_biases({}, seed, 0.005, 0.05);
    InertialFilter filter = slow_filter();
    for (int i = 0; i <= 10000; ++i) filter.update(reading(hand_motion(), i, seed, errors));
    tilt +=
        std::pow(tilt_error(hand_motion(), filter.world_from_imu(), 10) / filter.tilt_sigma(), 2) /
        2;
    bias += (filter.bias() - errors.rate_bias).squaredNorm() /
            (3 * filter.bias_sigma() * filter.bias_sigma());
  }
  // Expected 1, with deviations 0.16 and 0.13; the motion is smoother than the filter believes, so
  // that it may be cautious but not bold.
  EXPECT_LT(tilt / kRuns, 1.6);
  EXPECT_GT(tilt / kRuns, 0.05);
  EXPECT_LT(bias / kRuns, 1.5);
  EXPECT_GT(bias / kRuns, 0.05);
}

TEST(InertialFilter, ReadsItsBiasAtRest) {
  InertialFilter filter({});
  const Random random(1);
  const Eigen::Vector3d bias(0.05, -0.05, 0.05);
  const double sigma = 1e-3 / std::sqrt(kReading_s);
  for (std::uint64_t i = 0; i <= 2000; ++i) {
    ImuSample sample;
    sample.t_ns = static_cast<TimeNs>(i) * 1'000'000;
    sample.specific_force = kUp;
    sample.angular_velocity =
        bias +
        sigma * Eigen::Vector3d(random.normal(0, i), random.normal(1, i), random.normal(2, i));
    filter.update(sample);
  }
  EXPECT_TRUE(filter.is_at_rest());
  EXPECT_LT((filter.bias() - bias).norm(), 4 * std::sqrt(3) * 1e-3 / std::sqrt(2.0));
  EXPECT_NEAR(filter.bias_sigma(), 1e-3 / std::sqrt(2.0), 2e-4);
}

TEST(InertialFilter, AGapCostsTheTiltOnly) {
  InertialFilter filter = slow_filter();
  for (int i = 0; i <= 5000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  const Eigen::Vector3d bias = filter.bias();
  const double sigma = filter.tilt_sigma();
  filter.update(reading(hand_motion(), 6000, 1, {}));
  EXPECT_EQ(filter.gaps(), 1);
  EXPECT_EQ(filter.bias(), bias);
  EXPECT_GT(filter.tilt_sigma(), 5 * sigma);
  for (int i = 6001; i <= 16000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  EXPECT_LT(tilt_error(hand_motion(), filter.world_from_imu(), 16), 0.5 * kDegree);
}

}  // namespace
}  // namespace saccade
