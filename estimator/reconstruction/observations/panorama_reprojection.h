#pragma once

#include <optional>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/observations/panorama_projector.h"
#include "estimator/run/pose_table.h"

namespace saccade {

/// The reprojections of a rotating camera's pixels into a panorama over time; the panorama's world is
/// the reference of all poses. A direction is cheap, so each is computed exactly. In a panorama that
/// wraps, x continues beyond its sides, so that a pixel's reprojections are one continuous path.
class PanoramaReprojection {
 public:
  PanoramaReprojection(const PinholeCamera& camera, const Panorama& panorama);

  void start(const Trajectory& world_from_camera, TimeNs t_ns);
  /// To the next instant, at most `last_ns`.
  void advance(const Trajectory& world_from_camera, TimeNs last_ns);

  /// Time and pose of the last instant.
  [[nodiscard]] TimeNs end_ns() const { return end_.t_ns; }
  [[nodiscard]] const CameraPose& end_pose() const { return end_.world_from_camera; }

  /// Of an event between the last two instants.
  [[nodiscard]] std::optional<Reprojection> of(const Event& event);
  /// Of a pixel at the last instant.
  [[nodiscard]] std::optional<Reprojection> at_end(int x, int y) {
    return follow(x, y, end_.world_from_camera);
  }
  /// Image motion from an earlier pose to the last instant, as an angle in pixels of the panorama.
  [[nodiscard]] double moved_px(const CameraPose& earlier_from_world) const {
    return projector_.moved_px(end_.world_from_camera, earlier_from_world);
  }

 private:
  struct Instant {
    TimeNs t_ns = 0;
    CameraPose world_from_camera;
  };

  /// Continuing the path of the pixel's last reprojection.
  [[nodiscard]] std::optional<Reprojection> follow(int x, int y,
                                                   const CameraPose& world_from_camera);

  PanoramaProjector projector_;
  ImageF columns_;       ///< of the last reprojections
  Instant begin_, end_;  ///< around the current events
};

}  // namespace saccade
