#include "estimator/imu/complementary_filter.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "estimator/imu/tilt.h"

namespace saccade {
namespace {

/// From the identity towards dq by a share of `gain` (3.13-3.16).
Eigen::Quaterniond towards(const Eigen::Quaterniond& dq, double gain, double slerp_below) {
  const Eigen::Quaterniond identity = Eigen::Quaterniond::Identity();
  if (dq.w() < slerp_below) return identity.slerp(gain, dq);
  Eigen::Quaterniond mixed((1 - gain) + gain * dq.w(), gain * dq.x(), gain * dq.y(), gain * dq.z());
  mixed.normalize();
  return mixed;
}

}  // namespace

ComplementaryFilter::ComplementaryFilter(const ComplementaryOptions& options)
    : options_(options), bias_(options.bias, options.gravity) {}

void ComplementaryFilter::update(const ImuSample& sample) {
  if (!has_last_) {
    local_from_world_ = tilt_of(sample.specific_force).conjugate();
  } else {
    SACCADE_CHECK(sample.t_ns > last_.t_ns);
    const double dt_s = seconds_from_ns(sample.t_ns - last_.t_ns);
    if (dt_s > options_.max_gap_s) {
      // How it turned is unknown; the heading is kept, for want of a better one.
      ++gaps_;
      bias_.interrupt();
      correct(sample, 1);
    } else {
      bias_.add(sample, dt_s);
      predict(sample, dt_s);
      correct(sample, trust(sample.specific_force.norm()) *
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
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond(0, rate.x(), rate.y(), rate.z()) * local_from_world_;
  local_from_world_.coeffs() -= 0.5 * dt_s * turned.coeffs();
  local_from_world_.normalize();
}

void ComplementaryFilter::correct(const ImuSample& sample, double gain) {
  const double force = sample.specific_force.norm();
  if (!(gain > 0) || !(force > 0)) return;
  const Eigen::Vector3d gravity =
      local_from_world_.conjugate() * Eigen::Vector3d(sample.specific_force / force);
  local_from_world_ =
      local_from_world_ * towards(tilt_correction(gravity), gain, options_.slerp_below);
  local_from_world_.normalize();
}

double ComplementaryFilter::trust(double force) const {
  if (!options_.adaptive) return 1;
  const double error = std::abs(force - options_.gravity) / options_.gravity;
  return std::clamp((options_.no_trust - error) / (options_.no_trust - options_.full_trust), 0.0,
                    1.0);
}

}  // namespace saccade
