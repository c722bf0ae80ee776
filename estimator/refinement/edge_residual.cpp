#include "estimator/refinement/edge_residual.h"

#include <limits>

namespace saccade {

double edge_residual(const EdgeObservation& observation, const PinholeCamera& camera,
                     const Twist& motion, const EdgeUnknowns& edge, EdgeDerivatives* derivatives) {
  const Rigid3 view_from_camera = observation.view_from_camera * Rigid3::exp(motion);
  const Eigen::Matrix3d rotation = view_from_camera.rotation_matrix();
  const Eigen::Vector3d& origin = view_from_camera.translation();
  const Eigen::Vector3d direction = rotation * observation.ray;
  if (!(direction.z() > 0)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const Eigen::Vector2d a = direction.head<2>() / direction.z();
  const Eigen::Vector2d parallax = origin.head<2>() - origin.z() * a;
  const double rho = edge[0], tilt = edge[2];
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d from_edge =
      focal.cwiseProduct(a + rho * parallax) + centre - observation.pixel;
  const double larger = (1 - rho * origin.z()) / direction.z();
  if (!(larger > 0)) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d tangent(-observation.normal.y(), observation.normal.x());
  const double along = tangent.dot(from_edge);
  const double in_view =
      observation.normal.dot(from_edge) - edge[1] - tilt * along - edge[3] * observation.lag;
  if (derivatives != nullptr) {
    const Eigen::RowVector2d across =
        (observation.normal - tilt * tangent).cwiseProduct(focal).transpose();
    // Of o and a by (v, w): o' = R v, (R q)' = -R [q]x w.
    Eigen::Matrix<double, 3, 6> origin_by_motion = Eigen::Matrix<double, 3, 6>::Zero();
    origin_by_motion.leftCols<3>() = rotation;
    const Eigen::Matrix3d turn = -rotation * skew(observation.ray);
    Eigen::Matrix<double, 2, 6> a_by_motion = Eigen::Matrix<double, 2, 6>::Zero();
    a_by_motion.rightCols<3>() = (turn.topRows<2>() - a * turn.row(2)) / direction.z();
    const Eigen::Matrix<double, 2, 6> x_by_motion =
        (1 - rho * origin.z()) * a_by_motion +
        rho * (origin_by_motion.topRows<2>() - a * origin_by_motion.row(2));
    // exp(motion + d) = exp(motion) exp(J_r d).
    Eigen::Matrix<double, 1, 6> larger_by_motion = -rho * origin_by_motion.row(2);
    larger_by_motion.tail<3>() -= larger * turn.row(2);
    larger_by_motion /= direction.z();
    const double share = in_view / larger;
    // exp(motion + d) = exp(motion) exp(J_r d).
    derivatives->motion =
        (across * x_by_motion - share * larger_by_motion) / larger * se3_left_jacobian(-motion);
    derivatives->edge << across * parallax + share * origin.z() / direction.z(), -1, -along,
        -observation.lag;
    derivatives->edge /= larger;
  }
  return in_view / larger;
}

}  // namespace saccade
