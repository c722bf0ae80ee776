#pragma once

#include <algorithm>
#include <cmath>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// The smaller of the horizontal and the vertical angle of view [rad], without the lens.
[[nodiscard]] inline double angle_of_view(const PinholeCamera& camera) {
  return 2 * std::min(std::atan(0.5 * camera.width / camera.fx),
                      std::atan(0.5 * camera.height / camera.fy));
}

/// The angle between the directions that the camera looks in at two poses [rad]. A turn about the
/// viewing direction, which keeps most of the view, does not count.
[[nodiscard]] inline double view_turn(const Rigid3& a, const Rigid3& b) {
  const Eigen::Vector3d first = a.rotation() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d second = b.rotation() * Eigen::Vector3d::UnitZ();
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

}  // namespace saccade
