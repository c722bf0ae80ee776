#include "estimator/tracking/motion_field.h"

namespace saccade {

MotionField::MotionField(const PinholeCamera& camera, const Twist& camera_velocity,
                         const TemplateDrawer& drawer, double depth_elsewhere_m)
    : drawer_(drawer),
      motion_(camera, camera_velocity),
      inverse_depth_elsewhere_(static_cast<float>(1 / depth_elsewhere_m)) {}

Eigen::Vector2f MotionField::operator()(const Eigen::Vector2f& pixel) const {
  const float known =
      drawer_.inverse_depth(static_cast<int>(pixel.x() + 0.5F), static_cast<int>(pixel.y() + 0.5F));
  return motion_(pixel, known > 0 ? known : inverse_depth_elsewhere_);
}

}  // namespace saccade
