#include "estimator/imu/preintegration.h"

#include <gtest/gtest.h>

#include "tests/support/handheld_motion.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using testing::kGravity;
const ImuBias kReadingBias{{0.05, -0.04, 0.03}, {0.1, -0.2, 0.15}};
const ImuCalibration kNoise{1000, {1e-2, 0}, {1e-3, 0}};

struct Motion {
  Spline spline = testing::handheld_motion(2);
  std::vector<ImuSample> readings =
      testing::imu_readings(spline, Rigid3(), kReadingBias.gyro, kReadingBias.accel);
};

const Motion& motion() {
  static const Motion motion;
  return motion;
}

Eigen::Matrix<double, 9, 1> sums(const Preintegration& about, const Preintegration& sum) {
  Eigen::Matrix<double, 9, 1> all;
  all.head<3>() = so3_log(about.rotation.conjugate() * sum.rotation);
  all.segment<3>(3) = sum.velocity;
  all.tail<3>() = sum.position;
  return all;
}

TEST(Preintegration, CarriesTheTrueStateOn) {
  constexpr double kFrom_s = 0.5004, kTo_s = 1.2007;  // between two readings
  const auto sum = preintegrate(motion().readings, kFrom_s, kTo_s, kReadingBias, kNoise);
  ASSERT_TRUE(sum);
  const SplineState from = motion().spline.state(kFrom_s);
  const SplineState to = motion().spline.state(kTo_s);
  const double t_s = kTo_s - kFrom_s;
  EXPECT_NEAR(sum->duration_s, t_s, 1e-12);
  const Eigen::Quaterniond& rotation = from.world_from_body.rotation();
  EXPECT_LT(angle_between(rotation * sum->rotation, to.world_from_body.rotation()), 1e-5);
  EXPECT_LT(
      (from.velocity_in_world + kGravity * t_s + rotation * sum->velocity - to.velocity_in_world)
          .norm(),
      1e-4);
  EXPECT_LT(
      (from.world_from_body.translation() + from.velocity_in_world * t_s +
       0.5 * kGravity * t_s * t_s + rotation * sum->position - to.world_from_body.translation())
          .norm(),
      1e-4);
  EXPECT_LT((sum->first_rate - from.angular_velocity_in_body).norm(), 1e-3);
  EXPECT_LT((sum->last_rate - to.angular_velocity_in_body).norm(), 1e-3);
}

TEST(Preintegration, DerivativesByTheBiases) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const auto with = [](const Vector6& bias) {
    return *preintegrate(motion().readings, 0.3, 0.6, {bias.head<3>(), bias.tail<3>()}, kNoise);
  };
  const Vector6 at = (Vector6() << kReadingBias.gyro, kReadingBias.accel).finished();
  const Preintegration sum = with(at);
  testing::expect_jacobian<9, 6>(
      sum.bias_jacobian, [&](const Vector6& bias) { return sums(sum, with(bias)); }, at);
  const ImuBias other{kReadingBias.gyro + Eigen::Vector3d(0.01, 0, -0.01),
                      kReadingBias.accel * 1.1};
  const Preintegration anew = *preintegrate(motion().readings, 0.3, 0.6, other, kNoise);
  EXPECT_LT(angle_between(sum.rotation_with(other), anew.rotation), 1e-5);
  EXPECT_LT((sum.velocity_with(other) - anew.velocity).norm(), 1e-4);
  EXPECT_LT((sum.position_with(other) - anew.position).norm(), 1e-4);
}

TEST(Preintegration, CovarianceOfASensorAtRest) {
  std::vector<ImuSample> readings(1001);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i].t_ns = static_cast<TimeNs>(i) * 1'000'000;
  const auto sum = preintegrate(readings, 0, 1, {}, kNoise);
  ASSERT_TRUE(sum);
  // White noise of density d: d^2 T of the turn and of V, d^2 T^3 / 3 of P.
  EXPECT_NEAR(sum->covariance(0, 0), 1e-6, 1e-9);
  EXPECT_NEAR(sum->covariance(4, 4), 1e-4, 1e-7);
  EXPECT_NEAR(sum->covariance(8, 8), 1e-4 / 3, 1e-7);
}

TEST(Preintegration, NeedsReadingsAllAlong) {
  std::vector<ImuSample> readings = motion().readings;
  EXPECT_FALSE(preintegrate(readings, -0.1, 0.5, kReadingBias, kNoise));
  EXPECT_FALSE(preintegrate(readings, 1.5, 2.1, kReadingBias, kNoise));
  readings.erase(readings.begin() + 1000, readings.begin() + 1200);
  EXPECT_FALSE(preintegrate(readings, 0.9, 1.5, kReadingBias, kNoise));
  EXPECT_TRUE(preintegrate(readings, 1.3, 1.5, kReadingBias, kNoise));
  EXPECT_FALSE(preintegrate({}, 0, 1, kReadingBias, kNoise));
}

}  // namespace
}  // namespace saccade
