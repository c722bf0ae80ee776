#include "estimator/refinement/poses/log_intensity_sample.h"

#include <array>
#include <cmath>

namespace saccade {

Rigid3 corrected(const Rigid3& control, const double* correction) {
  const Eigen::Map<const Eigen::Vector3d> shift(correction), rotation(correction + 3);
  return {control.rotation() * so3_exp(rotation), control.translation() + shift};
}

LogIntensitySample sample_log_intensity(const MapSurface& surface, const MapSurface::Hit& hit,
                                        const Eigen::Vector3d& ray,
                                        const SplineKnots::LocalBasis& time,
                                        std::span<const Rigid3> controls,
                                        double const* const* corrections) {
  LogIntensitySample seen;
  std::array<Rigid3, 4> now;
  for (std::size_t k = 0; k < 4; ++k) now[k] = corrected(controls[k], corrections[k]);
  const PoseOverControls pose = pose_over(time, now);
  const Rigid3& view_from_map = surface.map().views()[hit.view].view_from_map;
  const PlaneReprojection reprojection = reproject_on_plane(
      surface.map().camera(), view_from_map * pose.world_from_body, ray, hit.plane);
  if (!reprojection.is_valid) return seen;
  const SampleWithGradient<double> map = surface.read(hit.view, reprojection.pixel);
  if (!std::isfinite(map.value)) return seen;
  seen.is_valid = true;
  seen.value = map.value;
  const Eigen::Matrix<double, 1, 6> by_motion =
      Eigen::RowVector2d(map.dx, map.dy) * reprojection.by_motion;
  const Eigen::RowVector3d by_shift = by_motion.head<3>() * view_from_map.rotation_matrix();
  for (int k = 0; k < 4; ++k) {
    // Exp(w + d) = Exp(w) Exp(J_r d).
    const Eigen::Map<const Eigen::Vector3d> rotation(corrections[k] + 3);
    seen.by_controls.segment<3>(kControlSize * k) = time.weight[k] * by_shift;
    seen.by_controls.segment<3>(kControlSize * k + 3) =
        by_motion.tail<3>() * pose.rotation_jacobian.middleCols<3>(3 * k) *
        so3_left_jacobian(-rotation);
  }
  return seen;
}

}  // namespace saccade
