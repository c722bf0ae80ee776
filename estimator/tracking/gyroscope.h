#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/imu_sample.h"

namespace saccade {

/// The camera's angular velocity as its gyroscope read it, linear between the readings.
class Gyroscope {
 public:
  Gyroscope() = default;
  /// `samples` in order of time, at least one; `camera_from_imu` turns their frame into the
  /// camera's. `bias` [rad/s] is in the sensor's frame.
  Gyroscope(std::span<const ImuSample> samples, const Eigen::Matrix3d& camera_from_imu,
            const Eigen::Vector3d& bias);

  [[nodiscard]] bool is_empty() const { return times_ns_.empty(); }

  /// Mean over [t0_ns, t1_ns], t0 <= t1, in the camera frame [rad/s]; before the first and after
  /// the last reading these hold.
  [[nodiscard]] Eigen::Vector3d mean_rate(TimeNs t0_ns, TimeNs t1_ns) const;

 private:
  [[nodiscard]] Eigen::Vector3d angle_at(TimeNs t_ns) const;
  [[nodiscard]] Eigen::Vector3d rate_at(TimeNs t_ns) const;

  std::vector<TimeNs> times_ns_;
  std::vector<Eigen::Vector3d> rates_;   ///< camera frame [rad/s]
  std::vector<Eigen::Vector3d> angles_;  ///< their integral since the first reading [rad]
};

}  // namespace saccade
