
#include <gtest/gtest.h>

#include <cmath>

#include "simulator/sensor/imu/imu.h"
#include "tests/support/allan.h"

namespace saccade {
namespace {

using Eigen::Vector3d;
using testing::allan_deviation;
using testing::log_slope;

constexpr double kRate_hz = 100;
constexpr double kDt_s = 1 / kRate_hz;
constexpr std::size_t kHour = 360'001;

/// Allan deviations at `taus`, the mean variance of the three axes.
template <class Reading>
std::vector<double> deviations(std::size_t count, const std::vector<double>& taus,
                               const Reading& reading) {
  std::vector<double> variances(taus.size(), 0.0);
  std::vector<double> axis_readings(count);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < count; ++k) axis_readings[k] = reading(k)[axis];
    for (std::size_t i = 0; i < taus.size(); ++i) {
      const auto m = static_cast<std::size_t>(std::lround(taus[i] * kRate_hz));
      variances[i] += std::pow(allan_deviation(axis_readings, kDt_s, m), 2) / 3;
    }
  }
  for (double& v : variances) v = std::sqrt(v);
  return variances;
}

Spline at_rest(double duration_s) {
  return Spline::from_control_poses(std::vector<Rigid3>(4), 0, duration_s);
}

// Over an hour and three axes a deviation at tau has a relative error of about
// sqrt(tau / (3 * 2 * 3600 s)): 0.7 % at 1 s, 4 % at 30 s. All bounds are five times that or more.

TEST(ImuNoise, WhiteNoiseFallsWithTheRootOfTau) {
  ImuOptions options{.rate_hz = kRate_hz, .gyroscope = {.density = 1.7e-3}};
  options.accelerometer.density = 0.02;
  const ImuRecording imu = record_imu(at_rest(3600), options, kStandardGravity, 5);
  ASSERT_EQ(imu.readings.size(), kHour);
  const std::vector<double> taus = {0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10};
  const auto gyro = deviations(kHour, taus, [&](std::size_t k) -> const Vector3d& {
    return imu.readings[k].angular_velocity;
  });
  const auto accel = deviations(kHour, taus, [&](std::size_t k) -> const Vector3d& {
    return imu.readings[k].specific_force;
  });
  EXPECT_NEAR(log_slope(taus, gyro), -0.5, 0.05);
  EXPECT_NEAR(log_slope(taus, accel), -0.5, 0.05);
  EXPECT_NEAR(gyro[4], 1.7e-3, 0.04 * 1.7e-3);
  EXPECT_NEAR(accel[4], 0.02, 0.04 * 0.02);
}

TEST(ImuNoise, TheRandomWalkOfTheBiasRisesWithTheRootOfTau) {
  ImuOptions options{.rate_hz = kRate_hz, .gyroscope = {.random_walk = 3e-4}};
  options.accelerometer.random_walk = 5e-3;
  const ImuRecording imu = record_imu(at_rest(3600), options, kStandardGravity, 6);
  const std::vector<double> taus = {0.5, 1, 2, 3, 5, 10, 20};
  const auto gyro = deviations(kHour, taus, [&](std::size_t k) -> const Vector3d& {
    return imu.readings[k].angular_velocity;
  });
  const auto accel = deviations(kHour, taus, [&](std::size_t k) -> const Vector3d& {
    return imu.readings[k].specific_force;
  });
  EXPECT_NEAR(log_slope(taus, gyro), 0.5, 0.05);
  EXPECT_NEAR(log_slope(taus, accel), 0.5, 0.05);
  EXPECT_NEAR(gyro[3], 3e-4, 0.07 * 3e-4);
  EXPECT_NEAR(accel[3], 5e-3, 0.07 * 5e-3);
}

TEST(ImuNoise, DensitiesDoNotDependOnTheRate) {
  const TriadNoise noise{.density = 0.1, .random_walk = 0};
  for (const double rate_hz : {50.0, 800.0}) {
    const auto count = static_cast<std::size_t>(400 * rate_hz);
    const auto errors =
        triad_errors(noise, Vector3d::Zero(), 1 / rate_hz, 1, ImuTriad::kGyroscope, count);
    std::vector<double> x;
    for (const TriadError& e : errors) x.push_back(e.white.x());
    // 400 s at tau = 1 s: 3.5 %.
    EXPECT_NEAR(allan_deviation(x, 1 / rate_hz, static_cast<std::size_t>(rate_hz)), 0.1, 0.02);
  }
}

TEST(ImuNoise, IsWhatSeparatesReadingsFromTheTruth) {
  ImuOptions options{.rate_hz = kRate_hz,
                     .gyroscope = {0.01, 0.001},
                     .accelerometer = {0.1, 0.02},
                     .gyro_bias = {0.1, -0.2, 0.3},
                     .accel_bias = {1, 2, -3}};
  const ImuRecording noisy = record_imu(at_rest(10), options, kStandardGravity, 1);
  EXPECT_EQ(noisy.truth[0].gyro_bias, options.gyro_bias);
  EXPECT_EQ(noisy.truth[0].accel_bias, options.accel_bias);
  EXPECT_NE(noisy.truth[1].gyro_bias, options.gyro_bias);
  Vector3d gyro_sum = Vector3d::Zero();
  Vector3d accel_sum = Vector3d::Zero();
  for (std::size_t k = 0; k < noisy.readings.size(); ++k) {
    const ImuTruth& truth = noisy.truth[k];
    EXPECT_EQ(truth.ideal.specific_force, Vector3d(0, 0, 9.81));
    gyro_sum += noisy.readings[k].angular_velocity - truth.gyro_bias;
    accel_sum += noisy.readings[k].specific_force - truth.ideal.specific_force - truth.accel_bias;
  }
  // Means over T = 10 s have sigma = density / sqrt(T).
  const auto count = static_cast<double>(noisy.readings.size());
  EXPECT_LT((gyro_sum / count).cwiseAbs().maxCoeff(), 5 * 0.01 / std::sqrt(10.0));
  EXPECT_LT((accel_sum / count).cwiseAbs().maxCoeff(), 5 * 0.1 / std::sqrt(10.0));
}

TEST(ImuNoise, IsOffByDefault) {
  const ImuRecording imu = record_imu(at_rest(1), {}, kStandardGravity, 1);
  for (std::size_t k = 0; k < imu.readings.size(); ++k) {
    EXPECT_EQ(imu.readings[k].specific_force, imu.truth[k].ideal.specific_force);
    EXPECT_EQ(imu.readings[k].angular_velocity, imu.truth[k].ideal.angular_velocity);
    EXPECT_EQ(imu.truth[k].gyro_bias, Vector3d::Zero());
  }
}

TEST(ImuNoise, BelongsToSeedTriadAxisAndReading) {
  const TriadNoise noise{.density = 1, .random_walk = 1};
  const auto draw = [&](std::uint64_t seed, ImuTriad triad, std::size_t count) {
    return triad_errors(noise, Vector3d::Zero(), kDt_s, seed, triad, count);
  };
  const auto whole = draw(1, ImuTriad::kGyroscope, 100);
  const auto piece = draw(1, ImuTriad::kGyroscope, 40);
  const auto other_seed = draw(2, ImuTriad::kGyroscope, 100);
  const auto other_triad = draw(1, ImuTriad::kAccelerometer, 100);
  for (std::size_t k = 0; k < piece.size(); ++k) {
    EXPECT_EQ(piece[k].white, whole[k].white);
    EXPECT_EQ(piece[k].bias, whole[k].bias);
    EXPECT_NE(other_seed[k].white.x(), whole[k].white.x());
    EXPECT_NE(other_triad[k].white.x(), whole[k].white.x());
    EXPECT_NE(whole[k].white.x(), whole[k].white.y());
  }
}

}  // namespace
}  // namespace saccade
