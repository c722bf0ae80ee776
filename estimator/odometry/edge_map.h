#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/edges/landmarks.h"
#include "estimator/odometry/keyframe.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade {

/// The map that the camera is tracked by: the edges of the active keyframes, in the world. A new
/// keyframe is always active; with it, of all others, those that show most of what the camera sees,
/// the older where they show as much, because they have drifted less.
class EdgeMap {
 public:
  /// At most `max_active` >= 1 keyframes (K); 1 replaces the map by every new one (the thesis).
  EdgeMap(int max_active, const PinholeCamera& camera)
      : max_active_(static_cast<std::size_t>(max_active)), camera_(camera.undistorted()) {}

  /// Adds a keyframe and chooses the active ones as of a camera.
  void add(Keyframe keyframe, const Rigid3& world_from_camera) {
    keyframes_.push_back(std::move(keyframe));
    activate_around(keyframes_.size() - 1, world_from_camera);
  }
  /// Chooses the active ones as of a camera and a keyframe that shall be among them.
  void activate_around(std::size_t keyframe, const Rigid3& world_from_camera) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < keyframes_.size(); ++i)
      if (i != keyframe) others.push_back(i);
    std::vector<std::size_t> chosen = most_visible(std::move(others), world_from_camera);
    if (chosen.size() >= max_active_) chosen.pop_back();
    chosen.push_back(keyframe);
    std::sort(chosen.begin(), chosen.end());
    activate(std::move(chosen));
  }
  /// Points of the keyframes whose views are older than a time and show most of what a camera
  /// sees, of as many as make up the map.
  [[nodiscard]] std::vector<Landmark> landmarks(double before_s,
                                                const Rigid3& world_from_camera) const {
    std::vector<std::size_t> older;
    for (std::size_t i = 0; i < keyframes_.size() && keyframes_[i].t_s < before_s; ++i)
      older.push_back(i);
    std::vector<Landmark> landmarks;
    for (const std::size_t i : most_visible(std::move(older), world_from_camera)) {
      const Keyframe& keyframe = keyframes_[i];
      for (const EdgePoint& point : keyframe.depth.points) {
        const double depth_m = 1 / static_cast<double>(point.inverse_depth);
        landmarks.push_back(
            {keyframe.world_from_camera * (depth_m * camera_.ray({point.x_px, point.y_px})),
             static_cast<double>(point.sigma) * depth_m});
      }
    }
    return landmarks;
  }
  /// Makes up the map of these, in order of time.
  void activate(std::vector<std::size_t> keyframes) {
    active_ = std::move(keyframes);
    points_ = {};
    for (const std::size_t i : active_) append(points_, keyframes_[i].edges);
  }

  [[nodiscard]] const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] std::vector<Keyframe>& keyframes() { return keyframes_; }
  /// Indices of those that make up the map, in order of time.
  [[nodiscard]] const std::vector<std::size_t>& active() const { return active_; }
  /// Their edges; the object stays the same.
  [[nodiscard]] const MapPoints& points() const { return points_; }

 private:
  [[nodiscard]] std::vector<std::size_t> most_visible(std::vector<std::size_t> keyframes,
                                                      const Rigid3& world_from_camera) const {
    std::vector<std::pair<double, std::size_t>> fractions;
    for (const std::size_t i : keyframes)
      if (const double fraction = visible_fraction(keyframes_[i], world_from_camera); fraction > 0)
        fractions.emplace_back(fraction, i);
    std::stable_sort(fractions.begin(), fractions.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    fractions.resize(std::min(fractions.size(), max_active_));
    keyframes.clear();
    for (const auto& [fraction, i] : fractions) keyframes.push_back(i);
    return keyframes;
  }
  /// Fraction of a keyframe's edges that a camera has in its view.
  [[nodiscard]] double visible_fraction(const Keyframe& keyframe,
                                        const Rigid3& world_from_camera) const {
    constexpr std::size_t kProbes = 400;
    const MapPoints& edges = keyframe.edges;
    const std::size_t step = std::max<std::size_t>(1, edges.size() / kProbes);
    const Rigid3 camera_from_world = world_from_camera.inverse();
    double visible = 0, probes = 0;
    for (std::size_t i = 0; i < edges.size(); i += step, ++probes) {
      const Eigen::Vector3d point =
          camera_from_world * Eigen::Vector3d(edges.x[i], edges.y[i], edges.z[i]);
      if (point.z() > 0 && camera_.contains(camera_.project(point))) ++visible;
    }
    return probes > 0 ? visible / probes : 0;
  }

  std::size_t max_active_;
  PinholeCamera camera_;
  std::vector<Keyframe> keyframes_;
  std::vector<std::size_t> active_;
  MapPoints points_;
};

}  // namespace saccade
