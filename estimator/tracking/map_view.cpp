#include "estimator/tracking/map_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade {
namespace {

/// Neighbours whose inverse depths differ by more than this share belong to two surfaces, unless
/// the next ones go on in the same way.
constexpr float kStep = 0.03F;
/// What two views show of one surface differs by less than this in inverse depth: the first one
/// drawn remains.
constexpr float kNearer = 1.01F;

/// Whether a row of inverse depths a, b, c, d belongs to one surface from b to c.
bool is_joined(float before, float b, float c, float after) {
  const float step = std::abs(c - b);
  if (step <= kStep * std::max(b, c)) return true;
  const auto goes_on = [&](float difference) {
    return std::abs(difference - (c - b)) < 0.3F * step;
  };
  return before > 0 && after > 0 && goes_on(b - before) && goes_on(after - c);
}

}  // namespace

MapView::MapView(const IntensityMap& map, int margin_px)
    : map_(map),
      margin_(margin_px),
      places_(map.camera().width + 2 * margin_px, map.camera().height + 2 * margin_px) {}

void MapView::draw(const Rigid3& map_from_camera) {
  map_from_camera_ = map_from_camera;
  for (SeenPlace& place : places_.pixels()) place.inverse_depth = 0;
  for (const std::size_t i : nearest_views()) {
    project(map_.views()[i]);
    draw_view(map_.views()[i]);
  }
  measure();
}

std::vector<std::size_t> MapView::nearest_views() const {
  constexpr std::size_t kMost = 3;
  std::vector<std::pair<double, std::size_t>> by_angle;
  for (std::size_t i = 0; i < map_.views().size(); ++i) {
    const Rigid3 view_from_camera = map_.views()[i].view_from_map * map_from_camera_;
    by_angle.emplace_back(so3_log(view_from_camera.rotation()).norm(), i);
  }
  std::sort(by_angle.begin(), by_angle.end());
  std::vector<std::size_t> nearest;
  for (std::size_t k = 0; k < std::min(kMost, by_angle.size()); ++k)
    nearest.push_back(by_angle[k].second);
  return nearest;
}

void MapView::project(const IntensityMap::View& view) {
  const Rigid3 camera_from_map = map_from_camera_.inverse();
  const Eigen::Matrix3f r = camera_from_map.rotation_matrix().cast<float>();
  const Eigen::Vector3f t = camera_from_map.translation().cast<float>();
  const PinholeCamera& camera = map_.camera();
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  vertices_.resize(view.points.size());
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    const Eigen::Vector3f p = r * view.points[i] + t;
    const bool is_known = view.inverse_depth[i] > 0 && p.z() > 0;
    const float inverse = is_known ? 1 / p.z() : 0;
    vertices_[i] = {fx * p.x() * inverse + cx, fy * p.y() * inverse + cy, inverse};
  }
}

void MapView::draw_view(const IntensityMap::View& view) {
  const int width = map_.camera().width;
  const int height = map_.camera().height;
  const auto depth = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < width && y < height;
    return is_inside ? view.inverse_depth[static_cast<std::size_t>(y * width + x)] : 0;
  };
  const auto corner = [&](int x, int y) -> Corner {
    const auto i = static_cast<std::size_t>(y * width + x);
    return {vertices_[i],
            view.points[i],
            {static_cast<float>(x), static_cast<float>(view.first_row + y)}};
  };
  for (int y = 0; y + 1 < height; ++y)
    for (int x = 0; x + 1 < width; ++x) {
      const Corner a = corner(x, y);
      const Corner b = corner(x + 1, y);
      const Corner c = corner(x, y + 1);
      const Corner d = corner(x + 1, y + 1);
      if (!(std::min(std::min(a.vertex.inverse_depth, b.vertex.inverse_depth),
                     std::min(c.vertex.inverse_depth, d.vertex.inverse_depth)) > 0))
        continue;
      const auto across = [&](int row) {
        return is_joined(depth(x - 1, row), depth(x, row), depth(x + 1, row), depth(x + 2, row));
      };
      const auto down = [&](int column) {
        return is_joined(depth(column, y - 1), depth(column, y), depth(column, y + 1),
                         depth(column, y + 2));
      };
      if (!across(y) || !across(y + 1) || !down(x) || !down(x + 1)) continue;
      draw_triangle(a, b, c);
      draw_triangle(b, d, c);
    }
}

void MapView::draw_triangle(const Corner& a, const Corner& b, const Corner& c) {
  constexpr float kSmallest = 0.02F;  // seen edge-on, or from behind
  const Vertex& p = a.vertex;
  const float bx = b.vertex.x - p.x;
  const float by = b.vertex.y - p.y;
  const float cx = c.vertex.x - p.x;
  const float cy = c.vertex.y - p.y;
  const float area = bx * cy - by * cx;
  if (!(area > kSmallest)) return;
  const auto [left, right] = std::minmax({p.x, b.vertex.x, c.vertex.x});
  const auto [top, bottom] = std::minmax({p.y, b.vertex.y, c.vertex.y});
  const auto edge = static_cast<float>(margin_);
  if (!(right >= -edge && bottom >= -edge && left < static_cast<float>(places_.width()) &&
        top < static_cast<float>(places_.height())))
    return;
  const int x0 = std::max(static_cast<int>(std::ceil(left)), -margin_);
  const int y0 = std::max(static_cast<int>(std::ceil(top)), -margin_);
  const int x1 = std::min(static_cast<int>(std::floor(right)), places_.width() - margin_ - 1);
  const int y1 = std::min(static_cast<int>(std::floor(bottom)), places_.height() - margin_ - 1);
  if (x0 > x1 || y0 > y1) return;
  const float scale = 1 / area;
  Eigen::Matrix2f from_image;
  from_image << cy, -cx, -by, bx;
  from_image *= scale;
  Eigen::Matrix2f places;
  places << b.place - a.place, c.place - a.place;
  const Eigen::Matrix2f slope = places * from_image;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2f offset(static_cast<float>(x) - p.x, static_cast<float>(y) - p.y);
      const Eigen::Vector2f weights = from_image * offset;
      // Half a thousandth of room, lest a pixel falls between two triangles.
      if (!(weights.x() >= -5e-4F && weights.y() >= -5e-4F && weights.sum() <= 1 + 5e-4F)) continue;
      const float inverse_depth = p.inverse_depth +
                                  weights.x() * (b.vertex.inverse_depth - p.inverse_depth) +
                                  weights.y() * (c.vertex.inverse_depth - p.inverse_depth);
      SeenPlace& seen = places_(x + margin_, y + margin_);
      if (inverse_depth <= kNearer * seen.inverse_depth) continue;
      seen = {a.point + weights.x() * (b.point - a.point) + weights.y() * (c.point - a.point),
              inverse_depth, a.place + slope * offset, slope};
    }
}

void MapView::measure() {
  double sum = 0;
  std::size_t known = 0;
  const PinholeCamera& camera = map_.camera();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float inverse_depth = (*this)(x, y).inverse_depth;
      sum += static_cast<double>(inverse_depth);
      known += inverse_depth > 0 ? 1 : 0;
    }
  coverage_ = static_cast<double>(known) / (camera.width * camera.height);
  typical_depth_m_ = known > 0 ? static_cast<double>(known) / sum : 1;
}

}  // namespace saccade
