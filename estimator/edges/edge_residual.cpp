#include "estimator/edges/edge_residual.h"

#include <limits>

namespace saccade {

Eigen::Matrix<double, 1, 4> EdgeLine::by_edge(const EdgeUnknowns& edge) const {
  const double g = magnification(edge[0]);
  Eigen::Matrix<double, 1, 4> derivative;
  derivative << across_by_rho - edge[2] * along_by_rho +
                    residual_in_view_px(edge) / g * origin_z / forward,
      -1, -(along_px + edge[0] * along_by_rho), -lag;
  return derivative / g;
}

EdgeLine line_of(const EdgeObservation& observation, const PinholeCamera& camera) {
  const Eigen::Vector3d direction = observation.view_from_camera.rotation() * observation.ray;
  const Eigen::Vector3d& origin = observation.view_from_camera.translation();
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d a = direction.head<2>() / direction.z();
  const Eigen::Vector2d from_edge = focal.cwiseProduct(a) + centre - observation.pixel;
  const Eigen::Vector2d by_rho = focal.cwiseProduct(origin.head<2>() - origin.z() * a);
  const Eigen::Vector2d tangent(-observation.normal.y(), observation.normal.x());
  return {observation.normal.dot(from_edge),
          observation.normal.dot(by_rho),
          tangent.dot(from_edge),
          tangent.dot(by_rho),
          origin.z(),
          direction.z(),
          observation.lag};
}

double edge_residual(const EdgeObservation& observation, const PinholeCamera& camera,
                     const Twist& motion, const EdgeUnknowns& edge, EdgeDerivatives* derivatives) {
  EdgeObservation moved = observation;
  moved.view_from_camera = observation.view_from_camera * Rigid3::exp(motion);
  const EdgeLine line = line_of(moved, camera);
  const double rho = edge[0];
  const double g = line.magnification(rho);
  if (!(line.forward > 0 && g > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double residual = line.residual_in_view_px(edge) / g;
  if (derivatives == nullptr) return residual;
  const Eigen::Matrix3d rotation = moved.view_from_camera.rotation_matrix();
  const Eigen::Vector3d direction = rotation * observation.ray;
  const Eigen::Vector2d a = direction.head<2>() / direction.z();
  const Eigen::Vector2d tangent(-observation.normal.y(), observation.normal.x());
  const Eigen::RowVector2d across = (observation.normal - edge[2] * tangent)
                                        .cwiseProduct(Eigen::Vector2d(camera.fx, camera.fy))
                                        .transpose();
  // Of o and a by (v, w): o' = R v, (R q)' = -R [q]x w.
  Eigen::Matrix<double, 3, 6> origin_by_motion = Eigen::Matrix<double, 3, 6>::Zero();
  origin_by_motion.leftCols<3>() = rotation;
  const Eigen::Matrix3d by_rotation = -rotation * skew(observation.ray);
  Eigen::Matrix<double, 2, 6> a_by_motion = Eigen::Matrix<double, 2, 6>::Zero();
  a_by_motion.rightCols<3>() = (by_rotation.topRows<2>() - a * by_rotation.row(2)) / direction.z();
  const Eigen::Matrix<double, 2, 6> x_by_motion =
      (1 - rho * line.origin_z) * a_by_motion +
      rho * (origin_by_motion.topRows<2>() - a * origin_by_motion.row(2));
  Eigen::Matrix<double, 1, 6> g_by_motion = -rho * origin_by_motion.row(2);
  g_by_motion.tail<3>() -= g * by_rotation.row(2);
  g_by_motion /= direction.z();
  // exp(motion + d) = exp(motion) exp(J_r d) (Barfoot, 2017, section 7.1.5).
  derivatives->motion =
      (across * x_by_motion - residual * g_by_motion) / g * se3_left_jacobian(-motion);
  derivatives->edge = line.by_edge(edge);
  return residual;
}

}  // namespace saccade
