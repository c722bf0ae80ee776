#include "core/spline/knots.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/spline/rotation.h"
#include "core/spline/segment.h"

namespace saccade {

SplineKnots SplineKnots::over(double start_s, double end_s, double spacing_s) {
  SACCADE_CHECK(end_s > start_s && spacing_s > 0);
  const double segments = std::max(1.0, std::round((end_s - start_s) / spacing_s));
  return {start_s, (end_s - start_s) / segments, static_cast<std::size_t>(segments)};
}

SplineKnots::LocalBasis SplineKnots::at(double t_s) const {
  static const CumulativeBasis uniform = bases_between(std::vector<double>{0, 1}).front();
  const double x = std::clamp((t_s - start_s) / spacing_s, 0.0, static_cast<double>(segments));
  LocalBasis local;
  local.first = std::min(static_cast<std::size_t>(x), segments - 1);
  local.basis = uniform.value(x - static_cast<double>(local.first));
  const Eigen::Array4d& b = local.basis;
  local.weight << 1 - b[0], b[0] - b[1], b[1] - b[2], b[2];
  return local;
}

PoseOverControls pose_over(const SplineKnots::LocalBasis& local,
                           const std::array<Rigid3, 4>& controls) {
  const RotationWithJacobian<12> rotation =
      rotation_between(local.basis, {controls[0].rotation(), controls[1].rotation(),
                                     controls[2].rotation(), controls[3].rotation()});
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    position += local.weight[static_cast<Eigen::Index>(k)] * controls[k].translation();
  return {Rigid3(rotation.rotation, position), rotation.jacobian};
}

}  // namespace saccade
