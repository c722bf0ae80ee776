#include "estimator/refinement/level_cost.h"

#include <cmath>

#include "estimator/refinement/jacobian_block.h"

namespace saccade {

Rigid3 corrected(const Rigid3& control, const double* correction) {
  const Eigen::Map<const Eigen::Vector3d> shift(correction), turn(correction + 3);
  return {control.rotation() * so3_exp(turn), control.translation() + shift};
}

bool LevelCost::Evaluate(double const* const* parameters, double* residuals,
                         double** jacobians) const {
  const Observation& o = observation_;
  std::array<Rigid3, 4> controls;
  for (std::size_t k = 0; k < 4; ++k) controls[k] = corrected(o.controls[k], parameters[k]);
  const PoseOverControls pose = pose_over(o.time, controls);
  const Rigid3& view_from_map = surface_.map().views()[o.hit.view].view_from_map;
  const SurfacePlace place = surface_place(
      surface_.map().camera(), view_from_map * pose.world_from_body, o.ray, o.hit.plane);
  if (!place.is_valid) return false;
  const SampleWithGradient<double> seen = surface_.read(o.hit.view, place.pixel);
  if (!std::isfinite(seen.value)) return false;
  residuals[0] = (seen.value - o.level - parameters[4][0]) / o.sigma;
  if (jacobians == nullptr) return true;
  const Eigen::RowVector2d slope = Eigen::RowVector2d(seen.dx, seen.dy) / o.sigma;
  const Eigen::Matrix<double, 1, 6> by_motion = slope * place.by_motion;
  const Eigen::RowVector3d by_shift = by_motion.head<3>() * view_from_map.rotation_matrix();
  for (int k = 0; k < 4; ++k) {
    // Exp(w + d) = Exp(w) Exp(J_r d).
    const Eigen::Map<const Eigen::Vector3d> turn(parameters[k] + 3);
    Eigen::Matrix<double, 1, kControlSize> by_control;
    by_control << o.time.weight[k] * by_shift, by_motion.tail<3>() *
                                                   pose.rotation_jacobian.middleCols<3>(3 * k) *
                                                   so3_left_jacobian(-turn);
    write_block(jacobians[k], by_control);
  }
  if (jacobians[4] != nullptr) jacobians[4][0] = -1 / o.sigma;
  return true;
}

}  // namespace saccade
