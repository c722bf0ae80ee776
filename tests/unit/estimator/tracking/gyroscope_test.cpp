#include "estimator/tracking/gyroscope.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rigid3.h"

namespace saccade {
namespace {

constexpr TimeNs kSampleStep = 5'000'000;

Eigen::Vector3d rate(double t_s) { return {std::sin(9 * t_s), 0.5 - 3 * t_s, std::cos(4 * t_s)}; }

std::vector<ImuSample> readings(int count) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < count; ++i) {
    ImuSample sample;
    sample.t_ns = i * kSampleStep;
    sample.angular_velocity = rate(seconds_from_ns(sample.t_ns));
    samples.push_back(sample);
  }
  return samples;
}

Gyroscope camera_gyroscope() {
  return {readings(100), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
}

TEST(Gyroscope, MeanRateIsTheIntegralOverTheTime) {
  const Gyroscope gyroscope = camera_gyroscope();
  for (const auto& [t0, t1] : {std::pair(0.0, 0.4), std::pair(0.0123, 0.0137),
                               std::pair(0.1012, 0.2999), std::pair(0.25, 0.255)}) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    constexpr int kParts = 1000;
    for (int i = 0; i < kParts; ++i) mean += rate(t0 + (t1 - t0) * (i + 0.5) / kParts) / kParts;
    const Eigen::Vector3d measured = gyroscope.mean_rate(ns_from_seconds(t0), ns_from_seconds(t1));
    EXPECT_LT((measured - mean).norm(), 5e-4) << t0;  // linear between readings: w'' dt^2 / 8
  }
}

TEST(Gyroscope, OfNoTimeIsTheRate) {
  EXPECT_LT((camera_gyroscope().mean_rate(20 * kSampleStep, 20 * kSampleStep) - rate(0.1)).norm(),
            1e-12);
}

TEST(Gyroscope, HoldsItsLastReadings) {
  const Gyroscope gyroscope = camera_gyroscope();
  EXPECT_LT((gyroscope.mean_rate(-50 * kSampleStep, -10 * kSampleStep) - rate(0)).norm(), 1e-12);
  EXPECT_LT((gyroscope.mean_rate(150 * kSampleStep, 170 * kSampleStep) - rate(0.495)).norm(),
            1e-12);
}

TEST(Gyroscope, TurnsIntoTheCameraAndTakesTheBiasOff) {
  const Eigen::Matrix3d camera_from_imu = so3_exp({0.3, -1, 0.4}).toRotationMatrix();
  const Eigen::Vector3d bias(0.1, -0.2, 0.05);
  const Gyroscope gyroscope(readings(100), camera_from_imu, bias);
  EXPECT_LT((gyroscope.mean_rate(20 * kSampleStep, 20 * kSampleStep) -
             camera_from_imu * (rate(0.1) - bias))
                .norm(),
            1e-12);
}

TEST(Gyroscope, OneReadingHoldsForAllTimes) {
  const Gyroscope gyroscope(readings(1), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  EXPECT_LT((gyroscope.mean_rate(-kSampleStep, 3 * kSampleStep) - rate(0)).norm(), 1e-12);
}

}  // namespace
}  // namespace saccade
