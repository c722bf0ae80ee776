#include "estimator/refinement/poses/visible_surface.h"

namespace saccade {

VisibleSurface::VisibleSurface(const MapSurface& surface, const SplineControls& map_from_camera,
                               double redraw_px)
    : surface_(surface),
      path_(map_from_camera.spline()),
      redraw_px_(redraw_px),
      view_(surface.map(), 1) {}

std::optional<MapSurface::Hit> VisibleSurface::at(double t_s, const Eigen::Vector2f& pixel,
                                                  const Eigen::Vector3d& ray) {
  draw_from(t_s);
  const Eigen::Vector2i node = view_.node_at(pixel);
  if (!view_.contains(node.x(), node.y())) return std::nullopt;
  return surface_.intersect(view_(node.x(), node.y()), pose_, ray);
}

void VisibleSurface::draw_from(double t_s) {
  constexpr double kStep_s = 1e-3;
  if (is_drawn_ && t_s == t_s_) return;
  t_s_ = t_s;
  pose_ = path_.pose(t_s);
  if (is_drawn_ && t_s - drawn_s_ <= kStep_s) return;
  if (!is_drawn_ || view_.moved_px(pose_) > redraw_px_) view_.draw(pose_);
  is_drawn_ = true;
  drawn_s_ = t_s;
}

}  // namespace saccade
