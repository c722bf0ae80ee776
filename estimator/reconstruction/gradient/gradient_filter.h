#pragma once

#include <span>
#include <vector>

#include "estimator/reconstruction/observations/intensity_observations.h"
#include "estimator/reconstruction/observations/reference_grid.h"

namespace saccade {

/// Prior standard deviation of either component of a gradient, sqrt(P0) of (6.6) [log units/px]: that
/// of strong texture, so that the prior hardly biases it.
inline constexpr double kGradientPriorSigma = 0.5;

/// The gradient of one pixel with its covariance.
struct GradientState {
  float gx = 0, gy = 0;             ///< g [log units/px]
  float pxx = 0, pxy = 0, pyy = 0;  ///< P

  /// One measurement of the extended Kalman filter (6.7)-(6.12), which is linear here: z = h g + n,
  /// n of variance `noise` > 0. The displacement of the point that a pixel observes, h = to - from in
  /// the reference view, is -A^-1 du of the scene's motion du in the camera, A = du_camera /
  /// du_reference. (The thesis prints h = du, without sign and A.)
  void update(float hx, float hy, float z, float noise);

  /// Smallest eigenvalue of the covariance: the variance in the best known direction.
  [[nodiscard]] float least_variance() const;
};

/// A pixel-wise Kalman filter on the gradient of the reference view. From one observation of an event
/// run to the next, L(to) - L(from) = g . (to - from) measures the gradient of the pixels along the
/// path. Its variance grows with the path, so that many short displacements weigh as much as one long
/// one, and a pixel's gradient is the mean over its area also where the image is steeper than pixels
/// can show.
class GradientFilter {
 public:
  /// `prior_variance` > 0: P0 of (6.6). `kinds` outlive this, and are complete before add().
  GradientFilter(const ReferenceGrid& grid, std::span<const ObservationKind> kinds,
                 double prior_variance);

  void add(std::span<const IntensityObservation> observations);

  [[nodiscard]] const std::vector<GradientState>& states() const { return states_; }

 private:
  void measure(const IntensityObservation& from, const IntensityObservation& to);

  const ReferenceGrid& grid_;
  std::span<const ObservationKind> kinds_;
  std::vector<GradientState> states_;
  std::vector<IntensityObservation> last_;  ///< of every run; x < 0: none
};

}  // namespace saccade
