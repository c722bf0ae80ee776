#include "estimator/imu/inertial_smoother.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/rigid3.h"
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

std::vector<ImuSample> record(const ImuMotion& motion, int count, const ImuErrors& errors) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back(reading(motion, i, 3, errors));
  return samples;
}

std::vector<ImuOrientation> smooth(const std::vector<ImuSample>& samples) {
  return smooth_orientations(samples, {}, {});
}

double tilt_rms(const std::vector<ImuOrientation>& orientations, const ImuMotion& motion) {
  double squares = 0;
  for (std::size_t i = 0; i < orientations.size(); ++i)
    squares += std::pow(
        tilt_error(motion, orientations[i].world_from_imu, static_cast<double>(i) * kReading_s), 2);
  return std::sqrt(squares / static_cast<double>(orientations.size()));
}

std::vector<ImuOrientation> filtered(const std::vector<ImuSample>& samples) {
  OrientationOptions options;
  options.method = OrientationOptions::Method::kInertial;
  return estimate_orientations(samples, options);
}

TEST(InertialSmoother, KnowsFromTheStartWhatTheFilterLearns) {
  const std::vector<ImuSample> samples = record(gentle_motion(), 5001, kUnknownBias);
  const std::vector<ImuOrientation> smoothed = smooth(samples);
  ASSERT_EQ(smoothed.size(), samples.size());
  const double causal = tilt_rms(filtered(samples), gentle_motion());
  EXPECT_LT(tilt_rms(smoothed, gentle_motion()), 0.5 * causal);
  // Of the bias what moves the tilt.
  const Eigen::Quaterniond first = gentle_motion().orientation(0);
  const Eigen::Vector3d missed =
      first * Eigen::Vector3d(smoothed.front().gyro.bias - kUnknownBias.rate_bias);
  EXPECT_LT(missed.head<2>().norm(), 0.02);
}

TEST(InertialSmoother, HoldsInAHand) {
  const std::vector<ImuSample> samples = record(hand_motion(), 10001, kUnknownBias);
  EXPECT_LT(tilt_rms(smooth(samples), hand_motion()),
            0.5 * tilt_rms(filtered(samples), hand_motion()));
}

TEST(InertialSmoother, TurnsWithTheGyroscope) {
  const std::vector<ImuSample> samples = record(gentle_motion(), 3001, kUnknownBias);
  const std::vector<ImuOrientation> smoothed = smooth(samples);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Eigen::Vector3d rate =
        0.5 * (samples[i - 1].angular_velocity + samples[i].angular_velocity) -
        smoothed[i].gyro.bias;
    const Eigen::Quaterniond turned = smoothed[i - 1].continuous * so3_exp(kReading_s * rate);
    // What is missed of the next tilt is spread over a hundred samples.
    EXPECT_LT(angle_between(turned, smoothed[i].continuous), 3e-4) << i;
  }
}

TEST(InertialSmoother, BeginsWithTheHeadingOfTheFirstSample) {
  const std::vector<ImuSample> samples = record(hand_motion(), 2001, {});
  const Eigen::Matrix3d axes = smooth(samples).front().world_from_imu.toRotationMatrix();
  EXPECT_NEAR(axes(1, 0), 0, 1e-9);  // x has no part to the left
  EXPECT_GT(axes(0, 0), 0);
}

TEST(InertialSmoother, FewSamplesAndGapsAreSurvived) {
  EXPECT_TRUE(smooth({}).empty());
  const std::vector<ImuSample> samples = record(gentle_motion(), 4001, kUnknownBias);
  for (const std::size_t count : {1U, 2U, 3U, 12U}) {
    const std::vector<ImuSample> few(samples.begin(), samples.begin() + static_cast<int>(count));
    const std::vector<ImuOrientation> smoothed = smooth(few);
    ASSERT_EQ(smoothed.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(smoothed[i].gyro.t_ns, few[i].t_ns);
      EXPECT_TRUE(smoothed[i].world_from_imu.coeffs().allFinite());
      EXPECT_TRUE(smoothed[i].gyro.bias.allFinite());
    }
  }
  // Half a second is missing, and every sample of what follows stands alone.
  std::vector<ImuSample> gaps(samples.begin(), samples.begin() + 2000);
  for (std::size_t i = 2500; i < samples.size(); i += 200) gaps.push_back(samples[i]);
  const std::vector<ImuOrientation> smoothed = smooth(gaps);
  ASSERT_EQ(smoothed.size(), gaps.size());
  for (std::size_t i = 0; i < gaps.size(); ++i)
    EXPECT_LT(tilt_error(gentle_motion(), smoothed[i].world_from_imu,
                         seconds_from_ns(gaps[i].t_ns - gaps.front().t_ns)),
              6 * kDegree)
        << i;
}

TEST(InertialSmoother, MergesByTheCovariances) {
  InertialState one, another;
  one.covariance = 4 * InertialState::Covariance::Identity();
  another.covariance = InertialState::Covariance::Identity();
  another.world_from_imu = so3_exp({0, 0, 1.3}) * so3_exp({0.01, 0, 0});
  another.bias = {0.1, 0.2, 0.3};
  another.accel_bias = {0, 0, 0.5};
  const InertialState merged = merged_state(one, another);
  const Eigen::Vector3d turned = so3_log(merged.world_from_imu);
  EXPECT_NEAR(turned.x(), 0.8 * 0.01, 1e-6);
  EXPECT_NEAR(turned.z(), 0, 1e-12);  // the heading of the first
  EXPECT_NEAR(merged.bias.x(), 0.8 * 0.1, 1e-12);
  EXPECT_NEAR(merged.bias.y(), 0.8 * 0.2, 1e-12);
  EXPECT_EQ(merged.bias.z(), 0);
  EXPECT_NEAR(merged.accel_bias.z(), 0.8 * 0.5, 1e-12);
  EXPECT_NEAR(merged.covariance(0, 0), 0.8, 1e-12);
  EXPECT_NEAR(merged.covariance(2, 2), 4, 1e-12);
}

TEST(InertialSmoother, AReversedMotionIsTheSameTheOtherWay) {
  InertialState state;
  state.bias = {1, 2, 3};
  state.velocity = {4, 5, 6};
  state.covariance = InertialState::Covariance::Random();
  state.covariance = (state.covariance * state.covariance.transpose()).eval();
  const InertialState there = reversed(state);
  EXPECT_EQ(there.bias, Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(there.velocity, Eigen::Vector3d(-4, -5, -6));
  EXPECT_EQ(there.covariance(0, InertialState::kBias), -state.covariance(0, InertialState::kBias));
  EXPECT_EQ(there.covariance(InertialState::kVelocity, InertialState::kBias),
            state.covariance(InertialState::kVelocity, InertialState::kBias));
  EXPECT_EQ(reversed(there).covariance, state.covariance);
}

}  // namespace
}  // namespace saccade
