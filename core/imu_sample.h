#pragma once

#include <Eigen/Core>

#include "core/event.h"

namespace saccade {

/// One reading of an inertial sensor, in its own frame.
struct ImuSample {
  TimeNs t_ns = 0;
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2]; +9.81 upwards at rest
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
};

}  // namespace saccade
