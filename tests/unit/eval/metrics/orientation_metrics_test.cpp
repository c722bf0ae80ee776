#include "eval/metrics/orientation_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Quaterniond turning(double t_s) {
  return so3_exp({0.5 * std::sin(t_s), 0.3 * std::cos(2 * t_s), 4 * t_s}) * so3_exp({1.4, 0.2, 0});
}

/// `error` is applied in the world, over 10 s.
template <class Error>
OrientationScoreInput input_with(const Error& error) {
  std::vector<StampedPose> estimate, truth;
  for (int i = 0; i <= 1000; ++i) {
    const double t_s = 0.01 * i;
    const Eigen::Quaterniond q = turning(t_s);
    truth.push_back({t_s, {q, {t_s, 0, 0}}});
    estimate.push_back({t_s, {Eigen::Quaterniond(error(t_s)) * q, {0, 0, 0}}});
  }
  return {Trajectory(estimate), Trajectory(truth), {}, {}};
}

TEST(OrientationMetrics, AHeadingOfItsOwnIsNoError) {
  const Metrics m = score_orientation(input_with([](double) { return so3_exp({0, 0, 2.5}); }));
  EXPECT_NEAR(*m.get("orientation.roll_pitch_rmse_deg"), 0, 1e-9);
  EXPECT_NEAR(*m.get("orientation.yaw_drift_deg_per_min"), 0, 1e-9);
}

TEST(OrientationMetrics, TellsTiltFromDrift) {
  // 2 degrees of tilt and 3 degrees per minute, through several turns of the camera.
  const auto m = score_orientation(input_with([](double t_s) {
    return so3_exp({0, 0, 1 + 0.05 * kDegree * t_s}) * so3_exp({2 * kDegree, 0, 0});
  }));
  EXPECT_NEAR(*m.get("orientation.roll_pitch_rmse_deg"), 2, 1e-9);
  EXPECT_NEAR(*m.get("orientation.yaw_drift_deg_per_min"), 3, 0.01);
}

TEST(OrientationMetrics, ADriftThroughHalfATurnIsContinuous) {
  const auto errors = [] {
    const auto input = input_with([](double t_s) { return so3_exp({0, 0, t_s}); });
    return orientation_errors(input.estimate, input.truth);
  }();
  ASSERT_EQ(errors.size(), 1001U);
  EXPECT_NEAR(errors.back().heading_rad, 10, 1e-9);
}

TEST(OrientationMetrics, TheBiasIsScoredAtTheEndOfTheFirstRest) {
  auto input = input_with([](double t_s) {
    // A heading that drifts in the first two seconds only, which do not count.
    return so3_exp({0, 0, std::min(t_s, 2.0)});
  });
  for (int i = 0; i <= 1000; ++i) {
    const bool at_rest = (i >= 10 && i <= 200) || i > 900;
    const double error = i <= 200 ? 3e-4 : 1;
    const TimeNs t_ns = TimeNs{i} * 10'000'000;
    input.biases.push_back({t_ns, {0.1 + error, -0.1, 0.2}, 1e-4, at_rest});
    ImuTruth truth;
    truth.ideal.t_ns = t_ns;
    truth.gyro_bias = {0.1, -0.1, 0.2};
    input.imu_truth.push_back(truth);
  }
  const Metrics m = score_orientation(input);
  EXPECT_NEAR(*m.get("orientation.bias_error_rad_s"), 3e-4 / std::sqrt(3), 1e-12);
  EXPECT_EQ(m.get("orientation.bias_sigma_rad_s"), 1e-4);
  EXPECT_NEAR(*m.get("orientation.yaw_drift_deg_per_min"), 0, 1e-6);
}

TEST(OrientationMetrics, WithoutTruthThereIsNone) {
  auto input = input_with([](double) { return Eigen::Quaterniond::Identity(); });
  input.truth = {};
  EXPECT_TRUE(score_orientation(input).empty());
}

TEST(OrientationMetrics, RatesAreScoredAgainstTheTruthBetweenItsEntries) {
  std::vector<StampedTwist> truth, estimate;
  for (int i = 0; i <= 10; ++i)
    truth.push_back({0.1 * i, Eigen::Vector3d::Zero(), {2.0 * i, 0, 0}});
  estimate.push_back({-0.5, Eigen::Vector3d::Zero(), {900, 0, 0}});  // outside
  estimate.push_back({0.25, Eigen::Vector3d::Zero(), {5, 0.3, 0}});
  estimate.push_back({0.55, Eigen::Vector3d::Zero(), {11, 0, -0.4}});
  estimate.push_back({7, Eigen::Vector3d::Zero(), {900, 0, 0}});  // outside
  const Metrics m = score_rates(estimate, truth);
  const double rmse = std::sqrt((0.09 + 0.16) / 2);
  EXPECT_NEAR(*m.get("orientation.rate_rmse_rad_s"), rmse, 1e-12);
  EXPECT_NEAR(*m.get("orientation.rate_peak_rad_s"), 11, 1e-12);
  EXPECT_NEAR(*m.get("orientation.rate_rmse_percent"), 100 * rmse / 11, 1e-9);
  EXPECT_TRUE(score_rates({}, truth).empty());
}

TEST(OrientationMetrics, WithoutTruthRatesAreScoredAgainstTheGyroscope) {
  // A ramp of 1 rad/s^2 about the camera's x axis, which is the sensor's y axis, with a vibration
  // that averages out, and a bias.
  const Rigid3 camera_from_imu(
      Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d::Zero());
  std::vector<ImuSample> gyroscope;
  for (int i = 0; i < 1000; ++i) {
    const double vibration = i % 2 == 0 ? 0.5 : -0.5;
    gyroscope.push_back({i * 1'000'000, Eigen::Vector3d::Zero(), {0.3, 1e-3 * i + vibration, 0.2}});
  }
  std::vector<StampedTwist> estimate;
  for (int i = 0; i < 9; ++i) {
    const double t_s = 0.1 * i + 0.1;
    const double error = i % 2 == 0 ? 0.01 : -0.01;
    estimate.push_back({t_s, Eigen::Vector3d::Zero(), {t_s + 0.1, error, 0}});
  }
  const Metrics m = score_rates_by_gyroscope(estimate, gyroscope, camera_from_imu);
  // The mean of the errors is 0.01 / 9.
  EXPECT_NEAR(*m.get("orientation.rate_rmse_rad_s"), 0.01 * std::sqrt(1 - 1.0 / 81), 1e-5);
  EXPECT_TRUE(score_rates_by_gyroscope({}, gyroscope, camera_from_imu).empty());
  EXPECT_TRUE(score_rates_by_gyroscope(estimate, {}, camera_from_imu).empty());
}

}  // namespace
}  // namespace saccade
