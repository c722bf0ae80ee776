#include "estimator/tracking/map_view.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// Two views of one surface differ by less than this factor in inverse depth: the first one drawn
/// remains.
constexpr float kNearer = 1.01F;

}  // namespace

MapView::MapView(const IntensityMap& map, int margin, int spacing_px)
    : map_(map),
      margin_(margin),
      spacing_(spacing_px),
      columns_((map.camera().width - 1) / spacing_px + 1),
      rows_((map.camera().height - 1) / spacing_px + 1),
      samples_(columns_ + 2 * margin, rows_ + 2 * margin) {
  SACCADE_CHECK(spacing_px >= 1 && margin >= 0);
  for (const IntensityMap::View& view : map.views()) {
    std::vector<std::uint8_t>& joined = is_joined_.emplace_back();
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x) joined.push_back(is_one_surface(view, x, y) ? 1 : 0);
  }
}

bool MapView::is_one_surface(const IntensityMap::View& view, int x, int y) const {
  if (x + 1 >= columns_ || y + 1 >= rows_) return false;
  for (int v = y * spacing_; v < (y + 1) * spacing_; ++v)
    for (int u = x * spacing_; u < (x + 1) * spacing_; ++u)
      if (view.is_joined[static_cast<std::size_t>(v * map_.camera().width + u)] == 0) return false;
  return true;
}

void MapView::draw(const Rigid3& map_from_camera) {
  map_from_camera_ = map_from_camera;
  for (MapSample& sample : samples_.pixels()) sample.inverse_depth = 0;
  for (const std::size_t i : nearest_views()) {
    project(map_.views()[i]);
    draw_view(map_.views()[i], is_joined_[i]);
  }
  measure();
}

double MapView::moved_px(const Rigid3& map_from_camera) const {
  constexpr int kEvery = 31;
  const Rigid3 camera_from_map = map_from_camera.inverse();
  double furthest = 0;
  for (int y = kEvery / 2; y < rows_; y += kEvery)
    for (int x = kEvery / 2; x < columns_; x += kEvery) {
      const MapSample& seen = (*this)(x, y);
      if (!(seen.inverse_depth > 0)) continue;
      const Eigen::Vector3d point = camera_from_map * seen.point.cast<double>();
      if (point.z() <= 0) return std::numeric_limits<double>::infinity();
      const Eigen::Vector2d drawn_at(x * spacing_, y * spacing_);
      furthest = std::max(furthest, (map_.camera().project(point) - drawn_at).norm());
    }
  return furthest;
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
  const auto fx = static_cast<float>(camera.fx / spacing_);
  const auto fy = static_cast<float>(camera.fy / spacing_);
  const auto cx = static_cast<float>(camera.cx / spacing_);
  const auto cy = static_cast<float>(camera.cy / spacing_);
  vertices_.clear();
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) {
      const std::size_t i = pixel_of(x, y);
      const Eigen::Vector3f p = r * view.points[i] + t;
      const bool is_known = view.inverse_depth[i] > 0 && p.z() > 0;
      const float inverse = is_known ? 1 / p.z() : 0;
      vertices_.push_back({fx * p.x() * inverse + cx, fy * p.y() * inverse + cy, inverse});
    }
}

void MapView::draw_view(const IntensityMap::View& view,
                        const std::vector<std::uint8_t>& is_joined) {
  const auto corner = [&](std::size_t node, int x, int y) -> Corner {
    return {vertices_[node],
            view.points[pixel_of(x, y)],
            {static_cast<float>(x * spacing_), static_cast<float>(view.first_row + y * spacing_)}};
  };
  const auto row = static_cast<std::size_t>(columns_);
  for (int y = 0; y + 1 < rows_; ++y)
    for (int x = 0; x + 1 < columns_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      if (is_joined[i] == 0) continue;
      const Nodes nodes =
          nodes_between(vertices_[i], vertices_[i + 1], vertices_[i + row], vertices_[i + row + 1]);
      if (nodes.is_empty()) continue;
      const Corner b = corner(i + 1, x + 1, y);
      const Corner c = corner(i + row, x, y + 1);
      draw_triangle(corner(i, x, y), b, c, nodes);
      draw_triangle(b, corner(i + row + 1, x + 1, y + 1), c, nodes);
    }
}

MapView::Nodes MapView::nodes_between(const Vertex& a, const Vertex& b, const Vertex& c,
                                      const Vertex& d) const {
  const float nearest = std::min(std::min(a.inverse_depth, b.inverse_depth),
                                 std::min(c.inverse_depth, d.inverse_depth));
  const float left = std::min(std::min(a.x, b.x), std::min(c.x, d.x));
  const float right = std::max(std::max(a.x, b.x), std::max(c.x, d.x));
  const float top = std::min(std::min(a.y, b.y), std::min(c.y, d.y));
  const float bottom = std::max(std::max(a.y, b.y), std::max(c.y, d.y));
  const auto edge = static_cast<float>(margin_);
  if (!(nearest > 0 && right >= -edge && bottom >= -edge &&
        left < static_cast<float>(samples_.width()) && top < static_cast<float>(samples_.height())))
    return {};
  return {std::max(static_cast<int>(std::ceil(left)), -margin_),
          std::max(static_cast<int>(std::ceil(top)), -margin_),
          std::min(static_cast<int>(std::floor(right)), samples_.width() - margin_ - 1),
          std::min(static_cast<int>(std::floor(bottom)), samples_.height() - margin_ - 1)};
}

void MapView::draw_triangle(const Corner& a, const Corner& b, const Corner& c, const Nodes& nodes) {
  constexpr float kSmallest = 0.02F;  // seen edge-on, or from behind
  const Vertex& p = a.vertex;
  const float bx = b.vertex.x - p.x;
  const float by = b.vertex.y - p.y;
  const float cx = c.vertex.x - p.x;
  const float cy = c.vertex.y - p.y;
  const float area = bx * cy - by * cx;
  if (!(area > kSmallest)) return;
  const float scale = 1 / area;
  const float per_pixel = 1 / static_cast<float>(spacing_);
  Eigen::Matrix2f from_image;
  from_image << cy, -cx, -by, bx;
  from_image *= scale;
  for (int y = nodes.top; y <= nodes.bottom; ++y)
    for (int x = nodes.left; x <= nodes.right; ++x) {
      const Eigen::Vector2f offset(static_cast<float>(x) - p.x, static_cast<float>(y) - p.y);
      const Eigen::Vector2f weights = from_image * offset;
      // Half a thousandth of room, lest a node falls between two triangles.
      if (!(weights.x() >= -5e-4F && weights.y() >= -5e-4F && weights.sum() <= 1 + 5e-4F)) continue;
      const float inverse_depth = p.inverse_depth +
                                  weights.x() * (b.vertex.inverse_depth - p.inverse_depth) +
                                  weights.y() * (c.vertex.inverse_depth - p.inverse_depth);
      MapSample& seen = samples_(x + margin_, y + margin_);
      if (inverse_depth <= kNearer * seen.inverse_depth) continue;
      Eigen::Matrix2f atlas_edges;
      atlas_edges << b.atlas_px - a.atlas_px, c.atlas_px - a.atlas_px;
      const Eigen::Matrix2f slope = atlas_edges * from_image;
      seen = {a.point + weights.x() * (b.point - a.point) + weights.y() * (c.point - a.point),
              inverse_depth, a.atlas_px + slope * offset, slope * per_pixel};
    }
}

void MapView::measure() {
  double sum = 0;
  std::size_t known = 0;
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) {
      const float inverse_depth = (*this)(x, y).inverse_depth;
      sum += static_cast<double>(inverse_depth);
      known += inverse_depth > 0 ? 1 : 0;
    }
  coverage_ = static_cast<double>(known) / (columns_ * rows_);
  typical_depth_m_ = known > 0 ? static_cast<double>(known) / sum : 1;
}

}  // namespace saccade
