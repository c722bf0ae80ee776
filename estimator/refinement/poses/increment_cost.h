#pragma once

#include <span>

#include <ceres/cost_function.h>

#include "estimator/refinement/poses/log_intensity_sample.h"

namespace saccade {

/// A pixel's brightness increment over a window of events before the map, by the control poses of
/// map_from_camera that rule its two ends:
///   r = (L(u, end) - L(u, begin) - increment) / sigma.
class IncrementCost : public ceres::CostFunction {
 public:
  /// An end of the window.
  struct Instant {
    SplineKnots::LocalBasis time;
    MapSurface::Hit hit;
  };
  struct Observation {
    Eigen::Vector3d ray;
    Instant begin, end;    ///< in this order
    double increment = 0;  ///< sum of p C [log units]
    double sigma = 1;      ///< [log units]
  };
  /// `controls`: all of the path's, before their corrections; they and `surface` outlive this. The
  /// unknowns are the corrections of first_control() and of the blocks() - 1 after it.
  IncrementCost(const Observation& observation, std::span<const Rigid3> controls,
                const MapSurface& surface);

  [[nodiscard]] std::size_t first_control() const { return observation_.begin.time.first; }
  [[nodiscard]] std::size_t blocks() const { return parameter_block_sizes().size(); }

  /// False where a ray leaves its plane or the picture.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  [[nodiscard]] LogIntensitySample seen(const Instant& instant,
                                        double const* const* parameters) const;

  Observation observation_;
  std::span<const Rigid3> controls_;
  const MapSurface& surface_;
};

}  // namespace saccade
