#include "estimator/imu/inertial_filter.h"

#include <Eigen/LU>

#include <cmath>

#include "core/check.h"
#include "core/rigid3.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

constexpr int kTheta = 0, kBias = 3, kVelocity = 6, kAccelBias = 9, kPosition = 12;
using Columns = Eigen::Matrix<double, 15, 3>;

// Noise of a consumer accelerometer; its exact values hardly matter beside the motion of a hand.
constexpr double kAccelDensity = 1e-2;     ///< [m/s^2/sqrt(Hz)]
constexpr double kAccelRandomWalk = 2e-4;  ///< [m/s^3/sqrt(Hz)]
constexpr double kAccelBiasSigma = 0.05;   ///< at the start [m/s^2]
constexpr double kTiltSigma = 0.1;         ///< of the tilt from one specific force [rad]
constexpr double kRestSpeedSigma = 0.01;   ///< of the velocity at rest [m/s]
/// Velocity and position of a hand decorrelate over these times: one pseudo-measurement for each.
constexpr double kVelocityTime_s = 1, kPositionTime_s = 0.5;
/// The covariance is propagated in steps of so many samples, which saves most of the time.
constexpr int kSamplesPerUpdate = 10;

}  // namespace

InertialFilter::InertialFilter(const InertialFilterOptions& options,
                               const GyroscopeNoise& gyroscope)
    : options_(options), gyroscope_(gyroscope), rest_(gyroscope.density) {
  const double gyro_sigma = gyroscope.bias_sigma;
  covariance_.diagonal().segment<3>(kBias).setConstant(gyro_sigma * gyro_sigma);
  covariance_.diagonal().segment<3>(kAccelBias).setConstant(kAccelBiasSigma * kAccelBiasSigma);
}

void InertialFilter::update(const ImuSample& sample) {
  if (!has_last_) {
    world_from_imu_ = tilt_from_specific_force(sample.specific_force);
    start(sample);
    return;
  }
  SACCADE_CHECK(sample.t_ns > last_.t_ns);
  const double dt_s = seconds_from_ns(sample.t_ns - last_.t_ns);
  if (dt_s > kMaxImuGap_s) {
    // The rotation during a gap is unknown: the tilt is read again, the heading kept.
    ++gaps_;
    world_from_imu_ = corrected_tilt(world_from_imu_, sample.specific_force);
    start(sample);
    return;
  }
  propagate(sample, dt_s);
  const auto window = rest_.add(sample, dt_s, bias_, bias_sigma());
  if (window || ++samples_since_update_ >= kSamplesPerUpdate) {
    const double interval_s = interval_s_;
    propagate_covariance();
    const double sigma = options_.velocity_sigma;
    measure(kVelocity, -velocity_, sigma * sigma * kVelocityTime_s / interval_s);
    if (const auto& reach = options_.position_sigma_m)
      measure(kPosition, -position_, *reach * *reach * kPositionTime_s / interval_s);
  }
  if (window) {
    measure(kVelocity, -velocity_, kRestSpeedSigma * kRestSpeedSigma);
    const double density = gyroscope_.density;
    measure(kBias, window->mean_rate - bias_, density * density / window->length_s);
  }
  last_ = sample;
}

void InertialFilter::start(const ImuSample& sample) {
  for (const int first : {kTheta, kVelocity, kPosition}) {
    covariance_.middleRows<3>(first).setZero();
    covariance_.middleCols<3>(first).setZero();
  }
  // The heading is zero by definition.
  covariance_.diagonal().segment<2>(kTheta).setConstant(kTiltSigma * kTiltSigma);
  covariance_.diagonal().segment<3>(kVelocity).setConstant(options_.velocity_sigma *
                                                           options_.velocity_sigma);
  // A free position starts at 0 by definition.
  const double reach = options_.position_sigma_m.value_or(0);
  covariance_.diagonal().segment<3>(kPosition).setConstant(reach * reach);
  velocity_.setZero();
  position_.setZero();
  force_sum_.setZero();
  interval_s_ = 0;
  samples_since_update_ = 0;
  rest_.interrupt();
  last_ = sample;
  has_last_ = true;
}

void InertialFilter::propagate(const ImuSample& sample, double dt_s) {
  const Eigen::Vector3d rate = 0.5 * (last_.angular_velocity + sample.angular_velocity) - bias_;
  const Eigen::Quaterniond half = so3_exp(0.5 * dt_s * rate);
  // The force acts at the orientation of the middle of the interval.
  const Eigen::Quaterniond middle = world_from_imu_ * half;
  const Eigen::Vector3d force =
      middle * Eigen::Vector3d(0.5 * (last_.specific_force + sample.specific_force) - accel_bias_);
  const Eigen::Vector3d dv = dt_s * (force - Eigen::Vector3d(0, 0, kGravity_m_s2));
  position_ += dt_s * (velocity_ + 0.5 * dv);
  velocity_ += dv;
  force_sum_ += dt_s * force;
  interval_s_ += dt_s;
  world_from_imu_ = (middle * half).normalized();
}

void InertialFilter::propagate_covariance() {
  const Eigen::Matrix3d rotation_dt = interval_s_ * world_from_imu_.toRotationMatrix();
  const Eigen::Matrix3d force_skew = skew(force_sum_);
  // P <- F P F^T; F is the identity but for three rows of blocks.
  const auto transform = [&](auto&& theta, auto&& bias, auto&& velocity, auto&& accel_bias,
                             auto&& position) {
    position += interval_s_ * velocity;
    velocity -= force_skew * theta + rotation_dt * accel_bias;
    theta -= rotation_dt * bias;
  };
  transform(covariance_.middleRows<3>(kTheta), covariance_.middleRows<3>(kBias),
            covariance_.middleRows<3>(kVelocity), covariance_.middleRows<3>(kAccelBias),
            covariance_.middleRows<3>(kPosition));
  transform(covariance_.middleCols<3>(kTheta).transpose(),
            covariance_.middleCols<3>(kBias).transpose(),
            covariance_.middleCols<3>(kVelocity).transpose(),
            covariance_.middleCols<3>(kAccelBias).transpose(),
            covariance_.middleCols<3>(kPosition).transpose());
  const auto add = [&](int first, double density) {
    covariance_.diagonal().segment<3>(first).array() += density * density * interval_s_;
  };
  add(kTheta, gyroscope_.density);
  add(kBias, gyroscope_.random_walk);
  add(kVelocity, kAccelDensity);
  add(kAccelBias, kAccelRandomWalk);
  force_sum_.setZero();
  interval_s_ = 0;
  samples_since_update_ = 0;
}

void InertialFilter::measure(int first, const Eigen::Vector3d& innovation, double variance) {
  const Columns cross_covariance = covariance_.middleCols<3>(first);
  Eigen::Matrix3d sum = covariance_.block<3, 3>(first, first);
  sum.diagonal().array() += variance;
  const Columns gain = cross_covariance * sum.inverse();
  const Eigen::Matrix<double, 15, 1> correction = gain * innovation;
  world_from_imu_ = (so3_exp(correction.segment<3>(kTheta)) * world_from_imu_).normalized();
  bias_ += correction.segment<3>(kBias);
  velocity_ += correction.segment<3>(kVelocity);
  accel_bias_ += correction.segment<3>(kAccelBias);
  position_ += correction.segment<3>(kPosition);
  covariance_ -= gain * cross_covariance.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

double InertialFilter::bias_sigma() const {
  return std::sqrt(covariance_.diagonal().segment<3>(kBias).mean());
}

double InertialFilter::tilt_sigma() const {
  return std::sqrt(covariance_.diagonal().segment<2>(kTheta).mean());
}

}  // namespace saccade
