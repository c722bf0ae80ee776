#pragma once

#include <span>

#include <Eigen/Core>

#include "core/spline/knots.h"
#include "estimator/refinement/poses/map_surface.h"

namespace saccade {

/// A control pose of the camera's path is corrected by (e, w): p + e in the map's axes, R Exp(w).
inline constexpr int kControlSize = 6;
[[nodiscard]] Rigid3 corrected(const Rigid3& control, const double* correction);

/// The map's log intensity at a pixel and an instant, by the four control poses of map_from_camera.
struct LogIntensitySample {
  bool is_valid = false;  ///< false: the ray leaves the plane or the picture
  double value = 0;       ///< L [log units]
  Eigen::Matrix<double, 1, 4 * kControlSize> by_controls;  ///< by their corrections
};

/// `controls` before their corrections, four of both; `hit` is the place that the pixel's `ray`
/// meets; its plane holds for any correction.
[[nodiscard]] LogIntensitySample sample_log_intensity(const MapSurface& surface,
                                                      const MapSurface::Hit& hit,
                                                      const Eigen::Vector3d& ray,
                                                      const SplineKnots::LocalBasis& time,
                                                      std::span<const Rigid3> controls,
                                                      double const* const* corrections);

}  // namespace saccade
