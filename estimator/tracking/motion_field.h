#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/edge_template.h"

namespace saccade {

/// Image motion of points at rest that a moving camera sees,
///   du/dt = dW/dxi (-V)   [px/s],
/// with dW/dxi the interaction matrix of the point's motion and V the camera's velocity (v, w) in
/// its own frame [m/s, rad/s]. The depth is the template's at this pixel, and `depth_elsewhere_m`
/// where no edge is known.
class MotionField {
 public:
  /// `camera` is undistorted; `drawer` outlives the field and is not drawn meanwhile.
  MotionField(const PinholeCamera& camera, const Twist& camera_velocity,
              const TemplateDrawer& drawer, double depth_elsewhere_m);

  /// At an undistorted position inside the image [px].
  [[nodiscard]] Eigen::Vector2f operator()(const Eigen::Vector2f& pixel) const;

 private:
  const TemplateDrawer& drawer_;
  float fx_, fy_, cx_, cy_;
  float inverse_fx_, inverse_fy_;
  float inverse_depth_elsewhere_;
  Eigen::Vector3f v_, w_;  ///< of the points: minus the camera's
};

}  // namespace saccade
