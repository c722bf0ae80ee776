#pragma once

#include <optional>

#include "core/spline/knots.h"
#include "estimator/refinement/poses/map_surface.h"

namespace saccade {

/// The points of a map that are visible to pixels along a path; asked for in the order of time, for
/// the map is drawn anew as the view moves on.
class VisibleSurface {
 public:
  /// `redraw_px`: motion of the view after which the map is drawn anew. `surface` outlives this.
  VisibleSurface(const MapSurface& surface, const SplineControls& map_from_camera,
                 double redraw_px);

  /// `pixel`, undistorted, and its ray. nullopt where nothing is known, and beside a jump of depth.
  [[nodiscard]] std::optional<MapSurface::Hit> at(double t_s, const Eigen::Vector2f& pixel,
                                                  const Eigen::Vector3d& ray);

 private:
  void draw_from(double t_s);

  const MapSurface& surface_;
  Spline path_;
  double redraw_px_;
  MapView view_;
  bool is_drawn_ = false;
  double t_s_ = 0, drawn_s_ = 0;
  Rigid3 pose_;  ///< at t_s_
};

}  // namespace saccade
