#include "estimator/depth/rays/edgel_index.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace saccade {
namespace {

std::pair<int, int> cell_of(const Eigen::Vector2f& pixel, const Image<int>& cells) {
  const auto clamped = [](float px, int size) {
    return std::clamp(static_cast<int>(std::lround(px)), 0, size - 1);
  };
  return {clamped(pixel.x(), cells.width()), clamped(pixel.y(), cells.height())};
}

}  // namespace

EdgelIndex::EdgelIndex(const PinholeCamera& camera, float spacing_px)
    : newest_(camera.width, camera.height, kNone), spacing_px_(spacing_px) {}

void EdgelIndex::add(const Edgel& edge) {
  const auto [x, y] = cell_of(edge.pixel, newest_);
  edges_.push_back({edge, newest_(x, y)});
  newest_(x, y) = static_cast<int>(edges_.size()) - 1;
}

bool EdgelIndex::has_similar(const Edgel& edge, float tolerance) const {
  const auto [cx, cy] = cell_of(edge.pixel, newest_);
  const int reach = static_cast<int>(std::ceil(spacing_px_));
  for (int y = std::max(cy - reach, 0); y <= std::min(cy + reach, newest_.height() - 1); ++y)
    for (int x = std::max(cx - reach, 0); x <= std::min(cx + reach, newest_.width() - 1); ++x)
      for (int i = newest_(x, y); i != kNone; i = edges_[static_cast<std::size_t>(i)].previous) {
        const Edgel& other = edges_[static_cast<std::size_t>(i)].edge;
        if ((other.pixel - edge.pixel).squaredNorm() < spacing_px_ * spacing_px_ &&
            other.normal.dot(edge.normal) > 0.5F &&
            std::abs(other.inverse_depth - edge.inverse_depth) <= tolerance)
          return true;
      }
  return false;
}

}  // namespace saccade
