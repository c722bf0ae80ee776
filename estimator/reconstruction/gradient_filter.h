#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

/// The gradient of one pixel with its covariance.
struct GradientState {
  float gx = 0, gy = 0;  ///< [log units/px]
  float pxx = 0, pxy = 0, pyy = 0;

  /// One measurement of the extended Kalman filter (6.7-6.12), which is linear here: z = h g + n, n
  /// of variance `noise` > 0. A displacement of the PLACE that a pixel sees, h = to - from in the
  /// reference view, is -A^-1 du of the scene's motion du in the camera, A = du_camera /
  /// du_reference.
  void update(float hx, float hy, float z, float noise);

  /// Smallest eigenvalue of the covariance: the variance in the direction that is known best.
  [[nodiscard]] float least_variance() const;
};

/// A pixel-wise Kalman filter on the gradient of the reference view. From one level of a track to
/// the next, L(to) - L(from) = g . (to - from) measures the gradient of the pixels along the path.
/// Its variance grows with the path, so that many short steps weigh as much as one long one and a
/// pixel's gradient is the mean over its area also where the image is steeper than pixels can show.
class GradientFilter {
 public:
  /// `prior_variance` > 0: P0 of (6.6).
  GradientFilter(const ReferenceGrid& grid, std::span<const LevelSort> sorts,
                 double prior_variance);

  void add(std::span<const PlaceLevel> levels);

  [[nodiscard]] const std::vector<GradientState>& states() const { return states_; }

 private:
  void measure(const PlaceLevel& from, const PlaceLevel& to);

  const ReferenceGrid& grid_;
  std::vector<LevelSort> sorts_;  ///< of levels
  std::vector<GradientState> states_;
  std::vector<PlaceLevel> last_;  ///< of every track; x < 0: none
};

}  // namespace saccade
