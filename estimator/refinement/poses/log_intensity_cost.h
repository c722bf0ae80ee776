#pragma once

#include <array>

#include <ceres/sized_cost_function.h>

#include "estimator/edges/least_squares/jacobian_block.h"
#include "estimator/refinement/poses/log_intensity_sample.h"

namespace saccade {

/// One event before the map, by the four control poses of map_from_camera at its time and the
/// offset of its event run:
///   r = (L(u, t) - relative_log_intensity - offset) / sigma.
class LogIntensityCost : public ceres::SizedCostFunction<1, kControlSize, kControlSize,
                                                         kControlSize, kControlSize, 1> {
 public:
  struct Observation {
    SplineKnots::LocalBasis time;
    std::array<Rigid3, 4> controls;  ///< of map_from_camera, before their corrections
    Eigen::Vector3d ray;
    double relative_log_intensity = 0;  ///< [log units]
    double sigma = 1;                   ///< [log units]
    MapSurface::Hit hit;
  };
  /// `surface` outlives this.
  LogIntensityCost(const Observation& observation, const MapSurface& surface)
      : observation_(observation), surface_(surface) {}

  /// False where the ray leaves the plane or the picture.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Observation& o = observation_;
    const LogIntensitySample seen =
        sample_log_intensity(surface_, o.hit, o.ray, o.time, o.controls, parameters);
    if (!seen.is_valid) return false;
    residuals[0] = (seen.value - o.relative_log_intensity - parameters[4][0]) / o.sigma;
    if (jacobians == nullptr) return true;
    for (int k = 0; k < 4; ++k)
      write_block(jacobians[k],
                  (seen.by_controls.segment<kControlSize>(kControlSize * k) / o.sigma).eval());
    if (jacobians[4] != nullptr) jacobians[4][0] = -1 / o.sigma;
    return true;
  }

 private:
  Observation observation_;
  const MapSurface& surface_;
};

}  // namespace saccade
