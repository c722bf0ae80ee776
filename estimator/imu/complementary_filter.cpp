#include "estimator/imu/complementary_filter.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

/// Adaptive gain: the relative error of the force's magnitude up to which the correction is
/// complete, and from which on there is none (the values of Valenti's ROS filter).
constexpr double kFullGainError = 0.1, kNoGainError = 0.2;

/// Interpolates from the identity to dq by `gain`: lerp where dq is a small rotation, slerp
/// otherwise (Valenti's threshold).
Eigen::Quaterniond interpolate(const Eigen::Quaterniond& dq, double gain) {
  constexpr double kSlerpBelow = 0.9;
  const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
  if (dq.w() < kSlerpBelow) return identity.slerp(gain, dq);  // (3.15-3.16)
  Eigen::Quaterniond mixed((1 - gain) + gain * dq.w(), gain * dq.x(), gain * dq.y(),
                           gain * dq.z());  // (3.13)
  mixed.normalize();                        // (3.14)
  return mixed;
}

}  // namespace

ComplementaryFilter::ComplementaryFilter(const ComplementaryOptions& options,
                                         const GyroscopeNoise& gyroscope)
    : options_(options), bias_(gyroscope) {}

void ComplementaryFilter::update(const ImuSample& sample) {
  if (!has_last_) {
    local_from_world_ = tilt_from_specific_force(sample.specific_force).conjugate();
  } else {
    SACCADE_CHECK(sample.t_ns > last_.t_ns);
    const double dt_s = seconds_from_ns(sample.t_ns - last_.t_ns);
    if (dt_s > kMaxImuGap_s) {
      // The rotation during a gap is unknown: the tilt is read again, the heading kept.
      ++gaps_;
      bias_.interrupt();
      correct(sample, 1);
    } else {
      if (options_.estimate_bias) bias_.add(sample, dt_s);
      predict(sample, dt_s);
      correct(sample, gain_factor(sample.specific_force.norm()) *
                          (1 - std::exp(-dt_s / options_.time_constant_s)));
    }
  }
  last_ = sample;
  has_last_ = true;
}

void ComplementaryFilter::predict(const ImuSample& sample, double dt_s) {
  Eigen::Vector3d rate = sample.angular_velocity;
  if (options_.integration == ComplementaryOptions::Integration::kTrapezoid)
    rate = 0.5 * (rate + last_.angular_velocity);
  rate -= bias_.bias();
  const Eigen::Quaterniond derivative =  // (3.5), but for the factor -1/2
      Eigen::Quaterniond(0, rate.x(), rate.y(), rate.z()) * local_from_world_;
  local_from_world_.coeffs() -= 0.5 * dt_s * derivative.coeffs();  // (3.6)
  local_from_world_.normalize();                                   // (3.7)
}

void ComplementaryFilter::correct(const ImuSample& sample, double gain) {
  const double force = sample.specific_force.norm();
  if (!(gain > 0) || !(force > 0)) return;
  const Eigen::Vector3d predicted_gravity =  // (3.9)
      local_from_world_.conjugate() * Eigen::Vector3d(sample.specific_force / force);
  local_from_world_ =  // (3.8)
      local_from_world_ * interpolate(tilt_correction(predicted_gravity), gain);
  local_from_world_.normalize();
}

double ComplementaryFilter::gain_factor(double force) const {
  if (!options_.adaptive) return 1;
  const double error = std::abs(force - kGravity_m_s2) / kGravity_m_s2;
  return std::clamp((kNoGainError - error) / (kNoGainError - kFullGainError), 0.0, 1.0);
}

}  // namespace saccade
