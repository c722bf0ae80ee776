#include "estimator/tracking/gyroscope.h"

#include <algorithm>
#include <functional>

#include "core/check.h"
#include "core/time_search.h"

namespace saccade {

Gyroscope::Gyroscope(std::span<const ImuSample> samples, const Eigen::Matrix3d& camera_from_imu,
                     const Eigen::Vector3d& bias) {
  SACCADE_CHECK(!samples.empty());
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) {
    const Eigen::Vector3d rate = camera_from_imu * (sample.angular_velocity - bias);
    if (!times_ns_.empty())
      angle += seconds_from_ns(sample.t_ns - times_ns_.back()) * (rates_.back() + rate) / 2;
    times_ns_.push_back(sample.t_ns);
    rates_.push_back(rate);
    angles_.push_back(angle);
  }
}

Eigen::Vector3d Gyroscope::rate_at(TimeNs t_ns) const {
  if (t_ns <= times_ns_.front()) return rates_.front();
  if (t_ns >= times_ns_.back()) return rates_.back();
  const std::size_t i = count_until(times_ns_, t_ns, std::identity{});
  const double fraction = static_cast<double>(t_ns - times_ns_[i - 1]) /
                          static_cast<double>(times_ns_[i] - times_ns_[i - 1]);
  return rates_[i - 1] + fraction * (rates_[i] - rates_[i - 1]);
}

Eigen::Vector3d Gyroscope::angle_at(TimeNs t_ns) const {
  const std::size_t i = std::max<std::size_t>(count_until(times_ns_, t_ns, std::identity{}), 1);
  const double dt_s = seconds_from_ns(t_ns - times_ns_[i - 1]);
  return angles_[i - 1] + dt_s * (rates_[i - 1] + rate_at(t_ns)) / 2;
}

Eigen::Vector3d Gyroscope::mean_rate(TimeNs t0_ns, TimeNs t1_ns) const {
  SACCADE_CHECK(!is_empty() && t0_ns <= t1_ns);
  if (t0_ns == t1_ns) return rate_at(t0_ns);
  return (angle_at(t1_ns) - angle_at(t0_ns)) / seconds_from_ns(t1_ns - t0_ns);
}

}  // namespace saccade
