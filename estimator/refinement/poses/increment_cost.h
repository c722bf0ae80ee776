#pragma once

#include <span>

#include <ceres/cost_function.h>

#include "core/check.h"
#include "estimator/edges/least_squares/jacobian_block.h"
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
                const MapSurface& surface)
      : observation_(observation), controls_(controls), surface_(surface) {
    SACCADE_CHECK(observation.begin.time.first <= observation.end.time.first);
    const std::size_t between = observation.end.time.first - observation.begin.time.first;
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(between + 4, kControlSize);
  }

  [[nodiscard]] std::size_t first_control() const { return observation_.begin.time.first; }
  [[nodiscard]] std::size_t blocks() const { return parameter_block_sizes().size(); }

  /// False where a ray leaves its plane or the picture.
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const LogIntensitySample begin = seen(observation_.begin, parameters);
    const LogIntensitySample end = seen(observation_.end, parameters);
    if (!begin.is_valid || !end.is_valid) return false;
    const double weight = 1 / observation_.sigma;
    residuals[0] = weight * (end.value - begin.value - observation_.increment);
    if (jacobians == nullptr) return true;
    const auto later = static_cast<int>(observation_.end.time.first - first_control());
    for (int k = 0; k < static_cast<int>(blocks()); ++k) {
      Eigen::Matrix<double, 1, kControlSize> by_control;
      by_control.setZero();
      if (k < 4) by_control -= begin.by_controls.segment<kControlSize>(kControlSize * k);
      if (k >= later)
        by_control += end.by_controls.segment<kControlSize>(kControlSize * (k - later));
      write_block(jacobians[k], (weight * by_control).eval());
    }
    return true;
  }

 private:
  [[nodiscard]] LogIntensitySample seen(const Instant& instant,
                                        double const* const* parameters) const {
    const std::size_t first = instant.time.first;
    return sample_log_intensity(surface_, instant.hit, observation_.ray, instant.time,
                                controls_.subspan(first, 4),
                                parameters + (first - first_control()));
  }

  Observation observation_;
  std::span<const Rigid3> controls_;
  const MapSurface& surface_;
};

}  // namespace saccade
