#include "estimator/imu/inertial_filter.h"

#include <Eigen/LU>

#include <cmath>

#include "core/check.h"
#include "core/rigid3.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

using State = InertialState;
constexpr int kTheta = State::kTheta, kBias = State::kBias, kVelocity = State::kVelocity,
              kAccelBias = State::kAccelBias, kPosition = State::kPosition;
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

InertialState reversed(const InertialState& state) {
  InertialState to = state;
  to.bias = -state.bias;
  to.velocity = -state.velocity;
  for (const int first : {kBias, kVelocity}) {
    to.covariance.middleRows<3>(first) *= -1;
    to.covariance.middleCols<3>(first) *= -1;
  }
  return to;
}

InertialFilter::InertialFilter(const InertialFilterOptions& options,
                               const GyroscopeNoise& gyroscope)
    : options_(options), gyroscope_(gyroscope), rest_(gyroscope.density) {
  const double gyro_sigma = gyroscope.bias_sigma;
  state_.covariance.diagonal().segment<3>(kBias).setConstant(gyro_sigma * gyro_sigma);
  state_.covariance.diagonal()
      .segment<3>(kAccelBias)
      .setConstant(kAccelBiasSigma * kAccelBiasSigma);
}

void InertialFilter::update(const ImuSample& sample) {
  if (!has_last_) {
    state_.world_from_imu = tilt_from_specific_force(sample.specific_force);
    start(sample);
    return;
  }
  SACCADE_CHECK(sample.t_ns > last_.t_ns);
  const double dt_s = seconds_from_ns(sample.t_ns - last_.t_ns);
  if (dt_s > kMaxImuGap_s) {
    // The rotation during a gap is unknown: the tilt is read again, the heading kept.
    ++gaps_;
    state_.world_from_imu = corrected_tilt(state_.world_from_imu, sample.specific_force);
    start(sample);
    return;
  }
  integrate(sample, dt_s);
  const auto rest = rest_.add(sample, dt_s, state_.bias, bias_sigma());
  if (rest || ++samples_since_update_ >= kSamplesPerUpdate) {
    const double interval_s = interval_s_;
    propagate_covariance();
    bound(kVelocity, options_.velocity_sigma, kVelocityTime_s, interval_s);
    if (const auto& reach = options_.position_sigma_m)
      bound(kPosition, *reach, kPositionTime_s, interval_s);
  }
  if (rest) {
    if (rest->is_complete) measure(kVelocity, -state_.velocity, kRestSpeedSigma * kRestSpeedSigma);
    measure(kBias, rest->mean_rate - state_.bias, rest->rate_sigma * rest->rate_sigma);
  }
  last_ = sample;
}

InertialFilter InertialFilter::turned_back() const {
  InertialFilter back = *this;
  back.propagate();
  back.state_ = reversed(back.state_);
  // What was measured on the way here is measured again on the way back.
  back.state_.covariance *= 2;
  // Headings are those relative to this one from now on.
  back.state_.covariance.row(kTheta + 2).setZero();
  back.state_.covariance.col(kTheta + 2).setZero();
  back.last_ = reversed(last_);
  back.rest_.interrupt();
  return back;
}

void InertialFilter::start(const ImuSample& sample) {
  for (const int first : {kTheta, kVelocity, kPosition}) {
    state_.covariance.middleRows<3>(first).setZero();
    state_.covariance.middleCols<3>(first).setZero();
  }
  // The heading is zero by definition.
  state_.covariance.diagonal().segment<2>(kTheta).setConstant(kTiltSigma * kTiltSigma);
  state_.covariance.diagonal().segment<3>(kVelocity).setConstant(options_.velocity_sigma *
                                                                 options_.velocity_sigma);
  // A free position starts at 0 by definition.
  const double reach = options_.position_sigma_m.value_or(0);
  state_.covariance.diagonal().segment<3>(kPosition).setConstant(reach * reach);
  state_.velocity.setZero();
  state_.position.setZero();
  force_sum_.setZero();
  interval_s_ = 0;
  samples_since_update_ = 0;
  rest_.interrupt();
  last_ = sample;
  has_last_ = true;
}

void InertialFilter::integrate(const ImuSample& sample, double dt_s) {
  const Eigen::Vector3d rate =
      0.5 * (last_.angular_velocity + sample.angular_velocity) - state_.bias;
  const Eigen::Quaterniond half = so3_exp(0.5 * dt_s * rate);
  // The force acts at the orientation of the middle of the interval.
  const Eigen::Quaterniond middle = state_.world_from_imu * half;
  const Eigen::Vector3d force =
      middle *
      Eigen::Vector3d(0.5 * (last_.specific_force + sample.specific_force) - state_.accel_bias);
  const Eigen::Vector3d dv = dt_s * (force - Eigen::Vector3d(0, 0, kGravity_m_s2));
  state_.position += dt_s * (state_.velocity + 0.5 * dv);
  state_.velocity += dv;
  force_sum_ += dt_s * force;
  interval_s_ += dt_s;
  state_.world_from_imu = (middle * half).normalized();
}

void InertialFilter::propagate_covariance() {
  const Eigen::Matrix3d rotation_dt = interval_s_ * state_.world_from_imu.toRotationMatrix();
  const Eigen::Matrix3d force_skew = skew(force_sum_);
  // P <- F P F^T; F is the identity but for three rows of blocks.
  const auto transform = [&](auto&& theta, auto&& bias, auto&& velocity, auto&& accel_bias,
                             auto&& position) {
    position += interval_s_ * velocity;
    velocity -= force_skew * theta + rotation_dt * accel_bias;
    theta -= rotation_dt * bias;
  };
  transform(state_.covariance.middleRows<3>(kTheta), state_.covariance.middleRows<3>(kBias),
            state_.covariance.middleRows<3>(kVelocity), state_.covariance.middleRows<3>(kAccelBias),
            state_.covariance.middleRows<3>(kPosition));
  transform(state_.covariance.middleCols<3>(kTheta).transpose(),
            state_.covariance.middleCols<3>(kBias).transpose(),
            state_.covariance.middleCols<3>(kVelocity).transpose(),
            state_.covariance.middleCols<3>(kAccelBias).transpose(),
            state_.covariance.middleCols<3>(kPosition).transpose());
  const auto add = [&](int first, double density) {
    state_.covariance.diagonal().segment<3>(first).array() += density * density * interval_s_;
  };
  add(kTheta, gyroscope_.density);
  add(kBias, gyroscope_.random_walk);
  add(kVelocity, kAccelDensity);
  add(kAccelBias, kAccelRandomWalk);
  force_sum_.setZero();
  interval_s_ = 0;
  samples_since_update_ = 0;
}

void InertialFilter::bound(int first, double sigma, double time_s, double interval_s) {
  const Eigen::Vector3d value = first == kVelocity ? state_.velocity : state_.position;
  // What velocity and position are within `time_s` is one observation, since they hardly change in it.
  // An interval has its part of that: of the information by a larger variance, of the likelihood by
  // an exponent.
  Eigen::Matrix3d spread = state_.covariance.block<3, 3>(first, first);
  spread.diagonal().array() += sigma * sigma;
  log_likelihood_ -= 0.5 * interval_s / time_s *
                     (value.dot(spread.inverse() * value) + std::log(spread.determinant()));
  measure(first, -value, sigma * sigma * time_s / interval_s);
}

void InertialFilter::measure(int first, const Eigen::Vector3d& innovation, double variance) {
  const Columns cross_covariance = state_.covariance.middleCols<3>(first);
  Eigen::Matrix3d sum = state_.covariance.block<3, 3>(first, first);
  sum.diagonal().array() += variance;
  const Columns gain = cross_covariance * sum.inverse();
  const Eigen::Matrix<double, 15, 1> correction = gain * innovation;
  state_.world_from_imu =
      (so3_exp(correction.segment<3>(kTheta)) * state_.world_from_imu).normalized();
  state_.bias += correction.segment<3>(kBias);
  state_.velocity += correction.segment<3>(kVelocity);
  state_.accel_bias += correction.segment<3>(kAccelBias);
  state_.position += correction.segment<3>(kPosition);
  state_.covariance -= gain * cross_covariance.transpose();
  state_.covariance = (0.5 * (state_.covariance + state_.covariance.transpose())).eval();
}

double InertialFilter::bias_sigma() const {
  return std::sqrt(state_.covariance.diagonal().segment<3>(kBias).mean());
}

double InertialFilter::tilt_sigma() const {
  return std::sqrt(state_.covariance.diagonal().segment<2>(kTheta).mean());
}

}  // namespace saccade
