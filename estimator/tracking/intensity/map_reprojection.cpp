#include "estimator/tracking/intensity/map_reprojection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

/// Beyond the image the view reaches this much further than it may move before it is redrawn.
constexpr int kSpareNodes = 4;

/// A view of some 240 columns is fine enough: what lies between its nodes is extrapolated.
int spacing_of(const PinholeCamera& camera) {
  constexpr double kColumns = 240;
  return std::max(1, static_cast<int>(std::lround(camera.width / kColumns)));
}

double redraw_px(const IntensityOptions& options, const PinholeCamera& camera) {
  return camera.fx * options.redraw_deg * std::numbers::pi / 180;
}

int margin_of(const IntensityOptions& options, const PinholeCamera& camera) {
  return static_cast<int>(std::ceil(redraw_px(options, camera) / spacing_of(camera))) + kSpareNodes;
}

}  // namespace

MapReprojection::MapReprojection(const IntensityOptions& options, const PinholeCamera& camera,
                                 const IntensityMap& map)
    : camera_(camera.undistorted()),
      undistortion_(camera),
      map_(map),
      view_(map, margin_of(options, camera), spacing_of(camera)),
      redraw_px_(redraw_px(options, camera_)) {}

bool MapReprojection::is_outdated(const Rigid3& map_from_camera) const {
  return view_.moved_px(map_from_camera) >= redraw_px_;
}

std::optional<float> MapReprojection::log_intensity(const Eigen::Vector2f& pixel) const {
  const MapSample* at = sample_at(pixel);
  if (at == nullptr) return std::nullopt;
  const Eigen::Vector2i node = view_.node_at(pixel);
  const Eigen::Vector2f offset = pixel - (view_.spacing_px() * node).cast<float>();
  const Eigen::Vector2f atlas_px = at->atlas_px + at->atlas_per_pixel * offset;
  if (!is_inside(map_.atlas(), atlas_px.x(), atlas_px.y())) return std::nullopt;
  const float value = sample(map_.atlas(), atlas_px.x(), atlas_px.y());
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<MapLevels> MapReprojection::levels(const LogIntensityObservation& observation,
                                                 const MapSample& at, const Motion& motion) const {
  const Eigen::Vector2f atlas_px =
      at.atlas_px +
      at.atlas_per_pixel * (observation.pixel - project(at.point, observation.time_s, motion));
  const Eigen::Vector2f nearest = atlas_px.array().round();
  const ImageF& atlas = map_.atlas();
  if (!(nearest.x() >= 0 && nearest.y() >= 0 && nearest.x() < static_cast<float>(atlas.width()) &&
        nearest.y() < static_cast<float>(atlas.height())))
    return std::nullopt;
  const Eigen::Vector2i texel = nearest.cast<int>();
  return MapLevels{map_.least()(texel.x(), texel.y()), map_.greatest()(texel.x(), texel.y())};
}

std::vector<std::uint32_t> MapReprojection::steep_pixels(float least_slope) const {
  std::vector<std::uint32_t> pixels;
  const ImageF& atlas = map_.atlas();
  const int spacing = view_.spacing_px();
  for (int y = 0; y < camera_.height; y += spacing)
    for (int x = 0; x < camera_.width; x += spacing) {
      const MapSample* at = sample_at(undistortion_(x, y));
      if (at == nullptr) continue;
      const int u = static_cast<int>(at->atlas_px.x());
      const int v = static_cast<int>(at->atlas_px.y());
      if (u < 0 || v < 0 || u + 1 >= atlas.width() || v + 1 >= atlas.height()) continue;
      const Eigen::Vector2f slope(atlas(u + 1, v) - atlas(u, v), atlas(u, v + 1) - atlas(u, v));
      // Not so where it is unknown.
      if ((at->atlas_per_pixel.transpose() * slope).squaredNorm() >= least_slope * least_slope)
        pixels.push_back(static_cast<std::uint32_t>(y * camera_.width + x));
    }
  return pixels;
}

}  // namespace saccade
