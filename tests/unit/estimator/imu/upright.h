#pragma once

#include <numbers>

#include <Eigen/Core>

namespace saccade::testing {

/// Specific force at rest where z points up [m/s^2].
inline const Eigen::Vector3d kUp(0, 0, 9.81);

constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

}  // namespace saccade::testing
