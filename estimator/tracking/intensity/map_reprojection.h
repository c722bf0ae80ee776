#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/intensity/event_residual_batch.h"
#include "estimator/tracking/intensity/intensity_options.h"
#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/map_view.h"

namespace saccade {

/// The map's range of log intensities about a texel.
struct MapLevels {
  float least, greatest;
};

/// What the pixels of a camera see of a map: the map as it is rendered from near the camera's pose,
/// and where its points are at other times.
class MapReprojection {
 public:
  using Motion = EventResidualBatch::Motion;

  /// `camera` may be distorted; `map` outlives this.
  MapReprojection(const IntensityOptions& options, const PinholeCamera& camera,
                  const IntensityMap& map);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }  ///< undistorted
  [[nodiscard]] const IntensityMap& map() const { return map_; }
  [[nodiscard]] double typical_depth_m() const { return view_.typical_depth_m(); }
  /// A pixel of the sensor, undistorted.
  [[nodiscard]] Eigen::Vector2f undistorted(int x, int y) const { return undistortion_(x, y); }

  /// Renders the map at a pose.
  void draw(const Rigid3& map_from_camera) { view_.draw(map_from_camera); }
  /// Whether the pose has moved too far for what was rendered.
  [[nodiscard]] bool is_outdated(const Rigid3& map_from_camera) const;

  /// The map's sample at a node of the view; nullptr where it is not visible.
  [[nodiscard]] const MapSample* sample_at(const Eigen::Vector2f& pixel) const {
    const Eigen::Vector2i node = view_.node_at(pixel);
    if (!view_.contains(node.x(), node.y())) return nullptr;
    const MapSample& at = view_(node.x(), node.y());
    return at.inverse_depth > 0 ? &at : nullptr;
  }
  /// The map's sample under a pixel at a time; nullptr where it is not visible.
  [[nodiscard]] const MapSample* find_sample(const Eigen::Vector2f& pixel, float time_s,
                                             const Motion& motion) const {
    // What is visible there now was elsewhere in the view that was drawn: one step of a fixed
    // point.
    const MapSample* here = sample_at(pixel);
    if (here == nullptr) return nullptr;
    const Eigen::Vector2f before = pixel + (pixel - project(here->point, time_s, motion));
    return before.allFinite() ? sample_at(before) : nullptr;
  }
  /// Fetches the sample under a pixel into the cache.
  void prefetch(const Eigen::Vector2f& pixel) const {
    const Eigen::Vector2i node = view_.node_at(pixel);
    if (view_.contains(node.x(), node.y())) __builtin_prefetch(&view_(node.x(), node.y()));
  }

  /// The map's log intensity at a pixel, as it was rendered; nullopt where it is unknown.
  [[nodiscard]] std::optional<float> log_intensity(const Eigen::Vector2f& pixel) const;
  /// What an observation may see of the map, between its texels; nullopt beside the map.
  [[nodiscard]] std::optional<MapLevels> levels(const LogIntensityObservation& observation,
                                                const MapSample& at, const Motion& motion) const;
  /// Every pixel of the sensor, as far apart as the view's nodes, at which the map's slope is at
  /// least so great [log units/px]; by rows.
  [[nodiscard]] std::vector<std::uint32_t> steep_pixels(float least_slope) const;

 private:
  /// Where a point of the map is at a time.
  [[nodiscard]] Eigen::Vector2f project(const Eigen::Vector3f& point, float time_s,
                                        const Motion& motion) const {
    const Eigen::Vector3f at = motion.rotation * point + motion.translation;
    const Eigen::Vector3f v = motion.velocity.head<3>();
    const Eigen::Vector3f w = motion.velocity.tail<3>();
    const Eigen::Vector3f moved = at - time_s * (v + w.cross(at));
    return {
        static_cast<float>(camera_.fx) * moved.x() / moved.z() + static_cast<float>(camera_.cx),
        static_cast<float>(camera_.fy) * moved.y() / moved.z() + static_cast<float>(camera_.cy)};
  }

  PinholeCamera camera_;
  UndistortionTable undistortion_;
  const IntensityMap& map_;
  MapView view_;
  double redraw_px_;
};

}  // namespace saccade
