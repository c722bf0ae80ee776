#include "estimator/imu/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/rigid3.h"
#include "estimator/imu/complementary_filter.h"
#include "tests/unit/estimator/imu/upright.h"

namespace saccade {
namespace {

using testing::kDegree;
using testing::kUp;

constexpr double kStep_s = 1e-3;

/// A thing in a hand: some 3 m/s^2, 0.5 m/s, turning to and fro.
Eigen::Quaterniond orientation(double t_s) {
  return so3_exp(
             {0.5 * std::sin(2 * t_s), 0.6 * std::sin(1.3 * t_s + 1), 0.4 * std::sin(3 * t_s)}) *
         so3_exp({1.2, 0.1, -0.4});
}
Eigen::Vector3d acceleration(double t_s) {
  return {-3 * std::sin(5 * t_s), -2.5 * std::sin(7 * t_s + 0.5), -3 * std::cos(6 * t_s)};
}

struct Errors {
  Eigen::Vector3d rate_bias{0.004, -0.003, 0.002};
  Eigen::Vector3d force_bias{0.03, -0.02, 0.04};
  double rate_noise = 1e-4;   ///< [rad/s/sqrt(Hz)]
  double force_noise = 1e-2;  ///< [m/s^2/sqrt(Hz)]
};

ImuSample reading(int i, std::uint64_t seed, const Errors& errors) {
  const Random random(seed);
  const auto normal3 = [&](std::uint64_t stream) {
    const auto k = static_cast<std::uint64_t>(i);
    return Eigen::Vector3d(random.normal(stream, k), random.normal(stream + 1, k),
                           random.normal(stream + 2, k));
  };
  const double t_s = i * kStep_s;
  constexpr double kDelta_s = 1e-5;
  ImuSample sample;
  sample.t_ns = static_cast<TimeNs>(i) * 1'000'000;
  sample.specific_force = orientation(t_s).conjugate() * (acceleration(t_s) + kUp) +
                          errors.force_bias + errors.force_noise / std::sqrt(kStep_s) * normal3(0);
  sample.angular_velocity =
      so3_log(orientation(t_s - kDelta_s).conjugate() * orientation(t_s + kDelta_s)) /
          (2 * kDelta_s) +
      errors.rate_bias + errors.rate_noise / std::sqrt(kStep_s) * normal3(3);
  return sample;
}

double tilt_error(const Eigen::Quaterniond& estimate, double t_s) {
  const Eigen::Vector3d up = estimate * orientation(t_s).conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(std::hypot(up.x(), up.y()), up.z());
}

InertialFilter slow_filter() {
  return InertialFilter({.velocity_sigma = 0.5},
                        {.density = 1e-4, .random_walk = 1e-6, .bias_sigma = 0.005});
}

TEST(InertialFilter, TellsGravityFromAccelerationInMotion) {
  InertialFilter filter = slow_filter();
  ComplementaryFilter complementary({});
  double squares = 0, complementary_squares = 0, count = 0;
  for (int i = 0; i <= 30000; ++i) {
    const ImuSample sample = reading(i, 1, {});
    filter.update(sample);
    complementary.update(sample);
    if (i < 15000) continue;
    squares += std::pow(tilt_error(filter.world_from_imu(), i * kStep_s), 2);
    complementary_squares += std::pow(tilt_error(complementary.world_from_imu(), i * kStep_s), 2);
    ++count;
  }
  const double error = std::sqrt(squares / count);
  EXPECT_LT(error, 0.5 * kDegree);
  EXPECT_LT(error, 0.2 * std::sqrt(complementary_squares / count));
  // Most of the bias has been found without a rest; nothing tells the part along the vertical.
  const auto horizontal = [&](const Eigen::Vector3d& rate) {
    return (filter.world_from_imu() * rate).head<2>().norm();
  };
  EXPECT_LT(horizontal(filter.bias() - Errors{}.rate_bias), 0.4 * horizontal(Errors{}.rate_bias));
}

TEST(InertialFilter, ItsErrorsAreAsLargeAsItSays) {
  // One component of the tilt and the biases, over runs that differ in noise and biases.
  constexpr int kRuns = 40;
  double tilt = 0, bias = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<std::uint64_t>(run + 1);
    const Random random(seed);
    Errors errors;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::uint64_t>(k);
      errors.rate_bias[k] = 0.005 * random.normal(100, axis);
      errors.force_bias[k] = 0.05 * random.normal(101, axis);
    }
    InertialFilter filter = slow_filter();
    for (int i = 0; i <= 10000; ++i) filter.update(reading(i, seed, errors));
    tilt += std::pow(tilt_error(filter.world_from_imu(), 10) / filter.tilt_sigma(), 2) / 2;
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
  const double sigma = 1e-3 / std::sqrt(kStep_s);
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
  for (int i = 0; i <= 5000; ++i) filter.update(reading(i, 1, {}));
  const Eigen::Vector3d bias = filter.bias();
  const double sigma = filter.tilt_sigma();
  filter.update(reading(6000, 1, {}));
  EXPECT_EQ(filter.gaps(), 1);
  EXPECT_EQ(filter.bias(), bias);
  EXPECT_GT(filter.tilt_sigma(), 5 * sigma);
  for (int i = 6001; i <= 16000; ++i) filter.update(reading(i, 1, {}));
  EXPECT_LT(tilt_error(filter.world_from_imu(), 16), 0.5 * kDegree);
}

}  // namespace
}  // namespace saccade
