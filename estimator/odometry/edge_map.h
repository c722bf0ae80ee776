#pragma once

#include <cstddef>
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
  void add(Keyframe keyframe, const Rigid3& world_from_camera);
  /// Chooses the active ones as of a camera and a keyframe that shall be among them.
  void activate_around(std::size_t keyframe, const Rigid3& world_from_camera);
  /// Points of the keyframes whose views are older than a time and show most of what a camera
  /// sees, of as many as make up the map.
  [[nodiscard]] std::vector<Landmark> landmarks(double before_s,
                                                const Rigid3& world_from_camera) const;
  /// Makes up the map of these, in order of time.
  void activate(std::vector<std::size_t> keyframes);

  [[nodiscard]] const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] std::vector<Keyframe>& keyframes() { return keyframes_; }
  /// Indices of those that make up the map, in order of time.
  [[nodiscard]] const std::vector<std::size_t>& active() const { return active_; }
  /// Their edges; the object stays the same.
  [[nodiscard]] const MapPoints& points() const { return points_; }

 private:
  [[nodiscard]] std::vector<std::size_t> most_visible(std::vector<std::size_t> keyframes,
                                                      const Rigid3& world_from_camera) const;
  /// Fraction of a keyframe's edges that a camera has in its view.
  [[nodiscard]] double visible_fraction(const Keyframe& keyframe,
                                        const Rigid3& world_from_camera) const;

  std::size_t max_active_;
  PinholeCamera camera_;
  std::vector<Keyframe> keyframes_;
  std::vector<std::size_t> active_;
  MapPoints points_;
};

}  // namespace saccade
