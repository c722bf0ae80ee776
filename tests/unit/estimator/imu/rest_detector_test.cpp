#include "estimator/imu/rest_detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rigid3.h"
#include "tests/unit/estimator/imu/imu_motion.h"

namespace saccade {
namespace {

using testing::ImuErrors;
using testing::ImuMotion;
using testing::kReading_s;
using testing::reading;

constexpr double kDensity = 1e-3;  // rad/s/sqrt(Hz)
const ImuErrors kErrors{{0.05, -0.04, 0.03}, {0.03, -0.02, 0.04}, kDensity, 1e-2};

/// Turns about an axis by an angle over time [rad], and stays in place.
ImuMotion turning(const Eigen::Vector3d& axis, double (*angle)(double)) {
  return {[=](double t_s) { return so3_exp(angle(t_s) * axis); },
          [](double) { return Eigen::Vector3d::Zero().eval(); }};
}

struct Found {
  double rest_s = 0;
  Eigen::Vector3d rate_sum = Eigen::Vector3d::Zero();  ///< times the length
  int first = -1;                                      ///< reading at which a rest was found first
};
Found find(const ImuMotion& motion, int readings, const ImuErrors& errors = kErrors) {
  RestDetector detector(kDensity);
  Found found;
  for (int i = 0; i < readings; ++i) {
    const auto rest = detector.add(reading(motion, i, 5, errors), kReading_s, {0, 0, 0}, 0.1);
    if (!rest || !rest->is_complete) continue;
    if (found.first < 0) found.first = i;
    found.rest_s += rest->length_s;
    found.rate_sum += rest->length_s * rest->mean_rate;
  }
  return found;
}

TEST(RestDetector, CountsAllOfARest) {
  const Found found = find(turning({0, 0, 1}, [](double) { return 0.0; }), 2000);
  EXPECT_EQ(found.first, 399);  // four windows of 0.1 s, which are returned together
  EXPECT_NEAR(found.rest_s, 2, 1e-9);
  EXPECT_LT((found.rate_sum / found.rest_s - kErrors.rate_bias).norm(),
            4 * std::sqrt(3) * kDensity / std::sqrt(2.0));
}

TEST(RestDetector, RestsOnlyWhereTheSamplesMay) {
  RestDetector detector(kDensity);
  const ImuMotion still = turning({0, 0, 1}, [](double) { return 0.0; });
  int first = -1, nearly = -1;
  for (int i = 0; i < 2000 && first < 0; ++i) {
    ImuSample sample = reading(still, i, 5, kErrors);
    sample.may_rest = i >= 300 && i != 650;
    const auto rest = detector.add(sample, kReading_s, {0, 0, 0}, 0.1);
    if (rest) (rest->is_complete ? first : nearly) = i;
  }
  EXPECT_EQ(nearly, 499);  // the first two windows whose samples all may
  EXPECT_EQ(first, 1099);  // four from 0.7 s on, the one after that of the last which may not
}

TEST(RestDetector, ATurnThatComesToRestIsNoneBefore) {
  // About the vertical, so that gravity tells nothing; the rate falls from 0.3 rad/s to 0 in 2 s.
  const Found found = find(
      turning({0, 0, 1}, [](double t_s) { return t_s < 2 ? 0.3 * t_s - 0.075 * t_s * t_s : 0.3; }),
      3000);
  EXPECT_GE(found.first, 2000);
  EXPECT_GT(found.rest_s, 0.5);
}

TEST(RestDetector, ATiltAtAConstantRateIsNoRest) {
  // Without a bias, so that it is its gravity alone that tells it from one.
  const ImuErrors unbiased{{0, 0, 0}, {0, 0, 0}, kDensity, 1e-2};
  const ImuMotion motion = turning({1, 0, 0}, [](double t_s) { return 0.13 * t_s; });
  EXPECT_EQ(find(motion, 3000, unbiased).rest_s, 0);
}

TEST(RestDetector, ANoisyAccelerometerRestsToo) {
  const ImuErrors noisy{{0.05, -0.04, 0.03}, {0.03, -0.02, 0.04}, kDensity, 5e-2};
  EXPECT_GT(find(turning({0, 0, 1}, [](double) { return 0.0; }), 3000, noisy).rest_s, 2);
}

TEST(RestDetector, AnAccelerometerWhoseScaleIsOffRestsToo) {
  const ImuErrors off{{0.05, -0.04, 0.03}, {0, 0, 0.77}, kDensity, 1e-2};  // 10.6 m/s^2 at rest
  EXPECT_NEAR(find(turning({0, 0, 1}, [](double) { return 0.0; }), 2000, off).rest_s, 2, 1e-9);
}

TEST(RestDetector, NoTimeIsReturnedTwice) {
  // The force's error is at the limit of what passes for gravity, so that every other window fails.
  RestDetector detector(kDensity);
  double rest_s = 0;
  int windows = 0;
  for (int i = 0; i < 3000; ++i) {
    ImuSample sample;
    sample.t_ns = static_cast<TimeNs>(i) * 1'000'000;
    sample.specific_force = {0, 0, kGravity_m_s2 + (i / 100 % 2 == 0 ? 0.895 : 0.905)};
    sample.angular_velocity = {0.05, 0, 0};
    const auto rest = detector.add(sample, kReading_s, {0, 0, 0}, 0.1);
    if (!rest || !rest->is_complete) continue;
    rest_s += rest->length_s;
    ++windows;
  }
  EXPECT_GT(windows, 10);
  EXPECT_LE(rest_s, 3 + 1e-9);
}

TEST(RestDetector, NearlyAtRestItTellsARoughBiasOnce) {
  // Two slow movements a second, which are no rest.
  const ImuMotion motion =
      turning({0, 0, 1}, [](double t_s) { return 0.002 * std::sin(12 * t_s); });
  RestDetector detector(kDensity);
  int count = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto rest = detector.add(reading(motion, i, 5, kErrors), kReading_s, {0, 0, 0}, 0.1);
    if (!rest) continue;
    ++count;
    EXPECT_EQ(i, 199);
    EXPECT_FALSE(rest->is_complete);
    EXPECT_FALSE(detector.is_at_rest());
    EXPECT_LT((rest->mean_rate - kErrors.rate_bias).norm(), 2 * rest->rate_sigma);
  }
  EXPECT_EQ(count, 1);
  // Not where the bias is known better.
  RestDetector known(kDensity);
  for (int i = 0; i < 2000; ++i)
    EXPECT_FALSE(known.add(reading(motion, i, 5, kErrors), kReading_s, kErrors.rate_bias, 0.01));
}

TEST(RestDetector, ForgetsWhatWasBeforeAnInterruption) {
  RestDetector detector(kDensity);
  const ImuMotion still = turning({0, 0, 1}, [](double) { return 0.0; });
  const auto add = [&](int i) {
    return detector.add(reading(still, i, 5, kErrors), kReading_s, kErrors.rate_bias, 0.04);
  };
  for (int i = 0; i < 350; ++i) EXPECT_FALSE(add(i));
  detector.interrupt();
  for (int i = 350; i < 749; ++i) EXPECT_FALSE(add(i)) << i;
  EXPECT_TRUE(add(749));
  EXPECT_TRUE(detector.is_at_rest());
}

}  // namespace
}  // namespace saccade
