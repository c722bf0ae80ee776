#pragma once

#include <array>

#include <ceres/sized_cost_function.h>

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
                double** jacobians) const override;

 private:
  Observation observation_;
  const MapSurface& surface_;
};

}  // namespace saccade
