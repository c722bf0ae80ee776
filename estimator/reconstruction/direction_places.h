#pragma once

#include <optional>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/direction_finder.h"
#include "estimator/reconstruction/pose_table.h"

namespace saccade {

/// Where the pixels of a camera that only turns look in a panorama, whose world is the reference of
/// all poses. A direction costs little, so that each is found by itself. In a panorama that wraps,
/// x goes on beyond its sides, so that what a pixel passes is one path.
class DirectionPlaces {
 public:
  DirectionPlaces(const PinholeCamera& camera, const Panorama& panorama);

  void start(const Trajectory& world_from_camera, TimeNs t_ns);
  /// To the next time, at most `last_ns`.
  void advance(const Trajectory& world_from_camera, TimeNs last_ns);

  /// The time that was reached, and the camera there.
  [[nodiscard]] TimeNs end_ns() const { return end_.t_ns; }
  [[nodiscard]] const CameraPose& end_pose() const { return end_.world_from_camera; }

  /// Of an event between the last two times.
  [[nodiscard]] std::optional<Place> of(const Event& event);
  /// What a pixel sees at the time that was reached.
  [[nodiscard]] std::optional<Place> at_end(int x, int y) {
    return follow(x, y, end_.world_from_camera);
  }
  /// How far what the camera sees there was from that at an earlier pose: the furthest of a few
  /// points, an angle in pixels of the panorama.
  [[nodiscard]] double moved_px(const CameraPose& earlier_from_world) const {
    return finder_.moved_px(end_.world_from_camera, earlier_from_world);
  }

 private:
  struct Moment {
    TimeNs t_ns = 0;
    CameraPose world_from_camera;
  };

  /// In the turn of the pixel's last place.
  [[nodiscard]] std::optional<Place> follow(int x, int y, const CameraPose& world_from_camera);

  DirectionFinder finder_;
  ImageF columns_;      ///< of the last places
  Moment begin_, end_;  ///< around the events that are at hand
};

}  // namespace saccade
