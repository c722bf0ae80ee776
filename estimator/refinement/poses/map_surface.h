#pragma once

#include <cstddef>
#include <optional>

#include "core/image.h"
#include "estimator/refinement/poses/plane_reprojection.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"

namespace saccade {

/// The views of an intensity map as smooth functions: bicubic log intensity, and planes that touch
/// the surface.
class MapSurface {
 public:
  /// `map` outlives this.
  explicit MapSurface(const IntensityMap& map) : map_(map) {}

  [[nodiscard]] const IntensityMap& map() const { return map_; }

  /// Log intensity at a view's pixel and its slope [1/px]: cubic convolution (Keys, 1981), C1.
  /// Beyond the border the border goes on; NaN where the lens shows nothing, and far outside.
  [[nodiscard]] SampleWithGradient<double> read(std::size_t view,
                                                const Eigen::Vector2d& pixel) const;

  /// The tangent plane: through the square of pixels around `pixel`. nullopt beside an occluding edge: unless
  /// all squares around belong to one surface.
  [[nodiscard]] std::optional<ViewPlane> plane(std::size_t view,
                                               const Eigen::Vector2d& pixel) const;

  /// Intersection of a ray with the map.
  struct Hit {
    std::size_t view = 0;
    ViewPlane plane;
    Eigen::Vector2d pixel;  ///< of the view
  };
  /// The intersection of a camera's ray with the surface, near a known point of it: the ray meets the
  /// tangent plane there, then the one at that intersection. nullopt where that leaves the surface.
  [[nodiscard]] std::optional<Hit> intersect(const MapSample& seen, const Rigid3& map_from_camera,
                                             const Eigen::Vector3d& ray) const;

 private:
  const IntensityMap& map_;
};

/// Harmonic mean of the depths of points of the map in their views.
class MeanDepth {
 public:
  void add(const MapSurface& surface, const MapSurface::Hit& hit) {
    inverse_ += hit.plane.dot(surface.map().camera().ray(hit.pixel));
    ++count_;
  }
  /// 1 without any point.
  [[nodiscard]] double value_m() const {
    return count_ == 0 ? 1 : static_cast<double>(count_) / inverse_;
  }

 private:
  double inverse_ = 0;  ///< [1/m]
  std::size_t count_ = 0;
};

}  // namespace saccade
