#pragma once

#include <Eigen/Core>

#include "core/rigid3.h"

namespace saccade {

/// A camera that moves at constant velocity before a plane. In the frame of the camera at time 0,
///   reference_from_camera(t) = (exp(t w), t v),   1 / z = 1 + slope . (x, y) for the ray (x, y,
///   1):
/// the plane's depth in the viewing direction is the unit of length.
struct PlaneMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< v [depths/s]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      ///< w [rad/s]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();     ///< [-]

  /// m with m . X = 1 on the plane.
  [[nodiscard]] Eigen::Vector3d plane() const { return {slope.x(), slope.y(), 1}; }
  [[nodiscard]] Rigid3 reference_from_camera(double t_s) const {
    return {so3_exp(t_s * rate), t_s * velocity};
  }
  /// The same in the frame of the camera at another time; the unit of length is the depth there.
  [[nodiscard]] PlaneMotion seen_at(double t_s) const {
    const Rigid3 camera = reference_from_camera(t_s);
    const Eigen::Vector3d m =
        (camera.rotation().inverse() * plane()) / (1 - plane().dot(camera.translation()));
    return {m.z() * (camera.rotation().inverse() * velocity), rate, m.head<2>() / m.z()};
  }
  /// The same image motion in the viewing direction, with `fraction` of what a rotation and a
  /// translation across it have in common given to the translation.
  [[nodiscard]] PlaneMotion with_translation_fraction(double fraction) const {
    const Eigen::Vector2d across(velocity.x() + rate.y(), velocity.y() - rate.x());
    PlaneMotion motion = *this;
    motion.velocity.head<2>() = fraction * across;
    motion.rate.y() = (1 - fraction) * across.x();
    motion.rate.x() = -(1 - fraction) * across.y();
    return motion;
  }
};

}  // namespace saccade
