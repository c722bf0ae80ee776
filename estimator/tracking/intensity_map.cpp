#include "estimator/tracking/intensity_map.h"

#include <algorithm>

#include "core/check.h"

namespace saccade {
namespace {

IntensityMap::View lift(const PinholeCamera& camera, const ReferenceView& reference,
                        const Rigid3& map_from_view, int first_row) {
  IntensityMap::View view;
  view.view_from_map = map_from_view.inverse();
  view.first_row = first_row;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float depth = reference.depth(x, y);
      const bool is_known = depth > 0 && std::isfinite(reference.log_intensity(x, y));
      const Eigen::Vector3d point =
          map_from_view * (camera.ray({x, y}) * static_cast<double>(is_known ? depth : 0));
      view.points.emplace_back(point.cast<float>());
      view.inverse_depth.push_back(is_known ? 1 / depth : 0);
    }
  return view;
}

}  // namespace

IntensityMap::IntensityMap(const PinholeCamera& camera, std::span<const ReferenceView> views)
    : camera_(camera) {
  SACCADE_CHECK(!views.empty());
  world_from_map_ = views.front().world_from_reference;
  atlas_ = ImageF(camera.width, camera.height * static_cast<int>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const int first_row = camera.height * static_cast<int>(i);
    const auto pixels = views[i].log_intensity.pixels();
    std::copy(pixels.begin(), pixels.end(), &atlas_(0, first_row));
    views_.push_back(lift(camera, views[i],
                          world_from_map_.inverse() * views[i].world_from_reference, first_row));
  }
}

}  // namespace saccade
