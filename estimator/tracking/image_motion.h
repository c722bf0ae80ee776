#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// Motion field of a static scene that a moving camera sees,
///   du/dt = dW/dxi (-V)   [px/s],
/// with dW/dxi the interaction matrix of the point's motion and V the camera's velocity (v, w) in
/// its own frame [m/s, rad/s].
class ImageMotion {
 public:
  /// `camera` is undistorted.
  ImageMotion(const PinholeCamera& camera, const Twist& camera_velocity)
      : fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)),
        cx_(static_cast<float>(camera.cx)),
        cy_(static_cast<float>(camera.cy)),
        inverse_fx_(1 / fx_),
        inverse_fy_(1 / fy_),
        v_(-camera_velocity.head<3>().cast<float>()),
        w_(-camera_velocity.tail<3>().cast<float>()) {}

  /// At an undistorted position [px]; `inverse_depth` [1/m].
  [[nodiscard]] Eigen::Vector2f operator()(const Eigen::Vector2f& pixel,
                                           float inverse_depth) const {
    const float x = (pixel.x() - cx_) * inverse_fx_;
    const float y = (pixel.y() - cy_) * inverse_fy_;
    const float along_x = inverse_depth * (v_.x() - x * v_.z());
    const float along_y = inverse_depth * (v_.y() - y * v_.z());
    return {fx_ * (along_x - x * y * w_.x() + (1 + x * x) * w_.y() - y * w_.z()),
            fy_ * (along_y - (1 + y * y) * w_.x() + x * y * w_.y() + x * w_.z())};
  }

 private:
  float fx_, fy_, cx_, cy_;
  float inverse_fx_, inverse_fy_;
  Eigen::Vector3f v_, w_;  ///< of the points: minus the camera's
};

}  // namespace saccade
