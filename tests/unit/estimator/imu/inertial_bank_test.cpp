#include "estimator/imu/inertial_bank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/random.h"
#include "core/rigid3.h"
#include "estimator/imu/inertial_filter.h"
#include "tests/unit/estimator/imu/imu_motion.h"

namespace saccade {
namespace {

using testing::gentle_motion;
using testing::hand_motion;
using testing::ImuErrors;
using testing::ImuMotion;
using testing::kDegree;
using testing::kReading_s;
using testing::kUnknownBias;
using testing::reading;
using testing::tilt_error;
using testing::with_biases;

/// Gentle for ten seconds, then moved to and fro by 0.3 m, once in two seconds.
ImuMotion gentle_then_swept() {
  const ImuMotion gentle = gentle_motion();
  return {gentle.orientation, [gentle](double t_s) -> Eigen::Vector3d {
            const double sweep = t_s < 10 ? 0 : 3 * std::cos(M_PI * (t_s - 10));
            return gentle.acceleration(t_s) + Eigen::Vector3d(sweep, 0, 0);
          }};
}

template <class Filter>
double tilt_rms(Filter filter, const ImuMotion& motion, const ImuErrors& errors, int from, int to) {
  double squares = 0;
  for (int i = 0; i <= to; ++i) {
    filter.update(reading(motion, i, 3, errors));
    if (i >= from)
      squares += std::pow(tilt_error(motion, filter.world_from_imu(), i * kReading_s), 2);
  }
  return std::sqrt(squares / (to - from + 1));
}

TEST(InertialBank, FindsTheTiltOfAGentleMotion) {
  const InertialFilterOptions options;
  const double one = tilt_rms(InertialFilter(options), gentle_motion(), kUnknownBias, 0, 5000);
  const double bank = tilt_rms(InertialBank(options), gentle_motion(), kUnknownBias, 0, 5000);
  EXPECT_GT(one, 2 * kDegree);
  EXPECT_LT(bank, 0.7 * kDegree);
}

TEST(InertialBank, ItsFastestFilterHoldsInAHand) {
  const InertialFilterOptions options{.velocity_sigma = 0.5};
  const double one = tilt_rms(InertialFilter(options), hand_motion(), {}, 10000, 20000);
  const double bank = tilt_rms(InertialBank(options), hand_motion(), {}, 10000, 20000);
  EXPECT_LT(bank, 1.3 * one);

  InertialBank filter(options);
  for (int i = 0; i <= 10000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  EXPECT_GT(filter.probabilities()[0], 0.8);
}

TEST(InertialBank, FollowsAMotionThatChanges) {
  InertialBank filter({});
  for (int i = 0; i < 10000; ++i) filter.update(reading(gentle_then_swept(), i, 2, kUnknownBias));
  EXPECT_GT(filter.probabilities()[2], 0.5);
  // Less than a second of the new motion is enough to tell.
  for (int i = 10000; i < 10700; ++i)
    filter.update(reading(gentle_then_swept(), i, 2, kUnknownBias));
  EXPECT_LT(filter.probabilities()[2], 0.1);
  EXPECT_LT(tilt_rms(InertialBank({}), gentle_then_swept(), kUnknownBias, 11000, 20000),
            2 * kDegree);
}

TEST(InertialBank, ItsErrorsAreAsLargeAsItSays) {
  // One component of the tilt and the biases, over runs that differ in motion, noise and biases.
  constexpr int kRuns = 40;
  double tilt = 0, bias = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<std::uint64_t>(run + 1);
    const ImuErrors errors = with_biases({{}, {}, 1e-3, 1e-2}, seed, 0.05, 0.05);
    const ImuMotion motion = run % 2 == 0 ? hand_motion() : gentle_motion();
    InertialBank filter({});
    for (int i = 0; i <= 6000; ++i) filter.update(reading(motion, i, seed, errors));
    tilt += std::pow(tilt_error(motion, filter.world_from_imu(), 6) / filter.tilt_sigma(), 2) / 2;
    bias += (filter.bias() - errors.rate_bias).squaredNorm() /
            (3 * filter.bias_sigma() * filter.bias_sigma());
  }
  // Expected 1; both motions are smoother than the filters believe.
  EXPECT_LT(tilt / kRuns, 2);
  EXPECT_GT(tilt / kRuns, 0.05);
  EXPECT_LT(bias / kRuns, 2);
  EXPECT_GT(bias / kRuns, 0.05);
}

TEST(InertialBank, WhatIsContinuousFollowsWithoutTheJumpsOfTheMean) {
  InertialBank filter({});
  const auto angle = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
    return so3_log(a.conjugate() * b).norm();
  };
  double jump = 0, continuous_jump = 0, apart = 0;
  Eigen::Quaterniond mean, continuous;
  ImuSample before;
  for (int i = 0; i < 15000; ++i) {
    const ImuSample sample = reading(gentle_then_swept(), i, 2, kUnknownBias);
    filter.update(sample);
    if (i > 0) {
      const Eigen::Quaterniond turn = so3_exp(
          kReading_s * (0.5 * (before.angular_velocity + sample.angular_velocity) - filter.bias()));
      jump = std::max(jump, angle(mean * turn, filter.world_from_imu()));
      continuous_jump = std::max(continuous_jump, angle(continuous * turn, filter.continuous()));
    }
    if (i > 3000) apart = std::max(apart, angle(filter.continuous(), filter.world_from_imu()));
    before = sample;
    mean = filter.world_from_imu();
    continuous = filter.continuous();
  }
  EXPECT_LT(continuous_jump, 0.1 * jump);
  EXPECT_LT(apart, 5 * kDegree);
}

TEST(InertialBank, AfterALongGapAllFiltersAreAsLikely) {
  InertialBank filter({});
  for (int i = 0; i <= 3000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  const auto& before = filter.probabilities();
  ASSERT_GT(*std::max_element(before.begin(), before.end()), 0.6);
  filter.update(reading(hand_motion(), 100'000, 1, {}));
  for (const double probability : filter.probabilities()) EXPECT_NEAR(probability, 1.0 / 3, 0.01);
}

TEST(InertialBank, AGapIsSurvived) {
  InertialBank filter({});
  for (int i = 0; i <= 3000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  filter.update(reading(hand_motion(), 6000, 1, {}));
  EXPECT_EQ(filter.gaps(), 1);
  for (int i = 6001; i <= 20000; ++i) filter.update(reading(hand_motion(), i, 1, {}));
  EXPECT_LT(tilt_error(hand_motion(), filter.world_from_imu(), 20), 1 * kDegree);
}

}  // namespace
}  // namespace saccade
