#include "estimator/imu/inertial_filter.h"

#include <Eigen/LU>

#include <cmath>

#include "core/check.h"
#include "core/rigid3.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

constexpr int kTheta = 0, kBias = 3, kVelocity = 6, kForceBias = 9, kPosition = 12;
using Columns = Eigen::Matrix<double, 15, 3>;
constexpr double kRestSpeed = 0.01;  ///< deviation of the velocity at rest [m/s]

}  // namespace

InertialFilter::InertialFilter(const InertialOptions& options)
    : options_(options), rest_(options.rest, options.gravity, options.gyroscope.density) {
  const double rate_sigma = options.gyroscope.bias_sigma;
  const double force_sigma = options.accelerometer.bias_sigma;
  covariance_.diagonal().segment<3>(kBias).setConstant(rate_sigma * rate_sigma);
  covariance_.diagonal().segment<3>(kForceBias).setConstant(force_sigma * force_sigma);
}

void InertialFilter::update(const ImuSample& sample) {
  if (!has_last_) {
    world_from_imu_ = tilt_of(sample.specific_force);
    start(sample);
    return;
  }
  SACCADE_CHECK(sample.t_ns > last_.t_ns);
  const double dt_s = seconds_from_ns(sample.t_ns - last_.t_ns);
  if (dt_s > options_.max_gap_s) {
    // How it turned is unknown; the heading is kept, for want of a better one.
    ++gaps_;
    world_from_imu_ = with_tilt_of(world_from_imu_, sample.specific_force);
    start(sample);
    return;
  }
  propagate(sample, dt_s);
  const auto window = rest_.add(sample, dt_s, bias_, bias_sigma());
  if (window || ++readings_ >= options_.readings_per_update) {
    const double interval_s = interval_s_;
    propagate_covariance();
    const double speed = options_.speed;
    measure(kVelocity, -velocity_, speed * speed * options_.speed_time_s / interval_s);
    if (options_.reach)
      measure(kPosition, -position_,
              *options_.reach * *options_.reach * options_.reach_time_s / interval_s);
  }
  if (window) {
    measure(kVelocity, -velocity_, kRestSpeed * kRestSpeed);
    const double density = options_.gyroscope.density;
    measure(kBias, window->mean_rate - bias_, density * density / window->length_s);
  }
  last_ = sample;
}

void InertialFilter::start(const ImuSample& sample) {
  for (const int first : {kTheta, kVelocity, kPosition}) {
    covariance_.middleRows<3>(first).setZero();
    covariance_.middleCols<3>(first).setZero();
  }
  // The heading is what it is by definition.
  covariance_.diagonal().segment<2>(kTheta).setConstant(options_.tilt_sigma * options_.tilt_sigma);
  covariance_.diagonal().segment<3>(kVelocity).setConstant(options_.speed * options_.speed);
  const double reach = options_.reach.value_or(0);  // else the position starts at 0 by definition
  covariance_.diagonal().segment<3>(kPosition).setConstant(reach * reach);
  velocity_.setZero();
  position_.setZero();
  force_sum_.setZero();
  interval_s_ = 0;
  readings_ = 0;
  rest_.interrupt();
  last_ = sample;
  has_last_ = true;
}

void InertialFilter::propagate(const ImuSample& sample, double dt_s) {
  const Eigen::Vector3d rate = 0.5 * (last_.angular_velocity + sample.angular_velocity) - bias_;
  const Eigen::Quaterniond half = so3_exp(0.5 * dt_s * rate);
  // The force is taken half way.
  const Eigen::Quaterniond middle = world_from_imu_ * half;
  const Eigen::Vector3d force =
      middle * Eigen::Vector3d(0.5 * (last_.specific_force + sample.specific_force) - force_bias_);
  const Eigen::Vector3d change = dt_s * (force - Eigen::Vector3d(0, 0, options_.gravity));
  position_ += dt_s * (velocity_ + 0.5 * change);
  velocity_ += change;
  force_sum_ += dt_s * force;
  interval_s_ += dt_s;
  world_from_imu_ = (middle * half).normalized();
}

void InertialFilter::propagate_covariance() {
  const Eigen::Matrix3d turned = interval_s_ * world_from_imu_.toRotationMatrix();
  const Eigen::Matrix3d pull = skew(force_sum_);
  // P <- F P F^T, where F is the identity but for three blocks.
  const auto transform = [&](auto&& theta, auto&& bias, auto&& velocity, auto&& force_bias,
                             auto&& position) {
    position += interval_s_ * velocity;
    velocity -= pull * theta + turned * force_bias;
    theta -= turned * bias;
  };
  transform(covariance_.middleRows<3>(kTheta), covariance_.middleRows<3>(kBias),
            covariance_.middleRows<3>(kVelocity), covariance_.middleRows<3>(kForceBias),
            covariance_.middleRows<3>(kPosition));
  transform(covariance_.middleCols<3>(kTheta).transpose(),
            covariance_.middleCols<3>(kBias).transpose(),
            covariance_.middleCols<3>(kVelocity).transpose(),
            covariance_.middleCols<3>(kForceBias).transpose(),
            covariance_.middleCols<3>(kPosition).transpose());
  const auto add = [&](int first, double density) {
    covariance_.diagonal().segment<3>(first).array() += density * density * interval_s_;
  };
  add(kTheta, options_.gyroscope.density);
  add(kBias, options_.gyroscope.random_walk);
  add(kVelocity, options_.accelerometer.density);
  add(kForceBias, options_.accelerometer.random_walk);
  force_sum_.setZero();
  interval_s_ = 0;
  readings_ = 0;
}

void InertialFilter::measure(int first, const Eigen::Vector3d& innovation, double variance) {
  const Columns to_measured = covariance_.middleCols<3>(first);
  Eigen::Matrix3d sum = covariance_.block<3, 3>(first, first);
  sum.diagonal().array() += variance;
  const Columns gain = to_measured * sum.inverse();
  const Eigen::Matrix<double, 15, 1> correction = gain * innovation;
  world_from_imu_ = (so3_exp(correction.segment<3>(kTheta)) * world_from_imu_).normalized();
  bias_ += correction.segment<3>(kBias);
  velocity_ += correction.segment<3>(kVelocity);
  force_bias_ += correction.segment<3>(kForceBias);
  position_ += correction.segment<3>(kPosition);
  covariance_ -= gain * to_measured.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

double InertialFilter::bias_sigma() const {
  return std::sqrt(covariance_.diagonal().segment<3>(kBias).mean());
}

double InertialFilter::tilt_sigma() const {
  return std::sqrt(covariance_.diagonal().segment<2>(kTheta).mean());
}

}  // namespace saccade
