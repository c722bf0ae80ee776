#include "estimator/tracking/motion_field.h"

namespace saccade {

MotionField::MotionField(const PinholeCamera& camera, const Twist& camera_velocity,
                         const TemplateDrawer& drawer, double depth_elsewhere_m)
    : drawer_(drawer),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      inverse_fx_(1 / fx_),
      inverse_fy_(1 / fy_),
      inverse_depth_elsewhere_(static_cast<float>(1 / depth_elsewhere_m)),
      v_(-camera_velocity.head<3>().cast<float>()),
      w_(-camera_velocity.tail<3>().cast<float>()) {}

Eigen::Vector2f MotionField::operator()(const Eigen::Vector2f& pixel) const {
  const float x = (pixel.x() - cx_) * inverse_fx_;
  const float y = (pixel.y() - cy_) * inverse_fy_;
  const float known =
      drawer_.inverse_depth(static_cast<int>(pixel.x() + 0.5F), static_cast<int>(pixel.y() + 0.5F));
  const float inverse_depth = known > 0 ? known : inverse_depth_elsewhere_;
  const float along_x = inverse_depth * (v_.x() - x * v_.z());
  const float along_y = inverse_depth * (v_.y() - y * v_.z());
  return {fx_ * (along_x - x * y * w_.x() + (1 + x * x) * w_.y() - y * w_.z()),
          fy_ * (along_y - (1 + y * y) * w_.x() + x * y * w_.y() + x * w_.z())};
}

}  // namespace saccade
