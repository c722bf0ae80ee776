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

  struct Instant {
    TimeNs t_ns = 0;
    CameraPose world_from_camera;

    [[nodiscard]] const CameraPose& pose() const { return world_from_camera; }
    /// A panorama needs none.
    [[nodiscard]] bool has_surfaces_of(const Instant&) const { return true; }
  };

  [[nodiscard]] Instant first(const Trajectory& world_from_camera, TimeNs t_ns) const {
    return {t_ns, pose_at(world_from_camera, Rigid3(), t_ns)};
  }
  /// The one after another, at most `last_ns`.
  [[nodiscard]] Instant next(const Instant& from, const Trajectory& world_from_camera,
                             TimeNs last_ns) const;

  /// Nothing to do: a direction follows from the pose alone.
  void follow(const Instant& instant, PixelRows rows) {
    static_cast<void>(instant);
    static_cast<void>(rows);
  }

  /// Of an event between two instants. One thread per pixel.
  [[nodiscard]] std::optional<Reprojection> of(const Event& event, const Instant& begin,
                                               const Instant& end);
  /// Of a pixel between them. One thread per pixel.
  [[nodiscard]] std::optional<Reprojection> between(int x, int y, const Instant& begin,
                                                    const Instant& end, float fraction);
  /// Of a pixel at an instant. One thread per pixel.
  [[nodiscard]] std::optional<Reprojection> at(int x, int y, const Instant& instant) {
    return continued(x, y, instant.world_from_camera);
  }
  /// Image motion from an earlier pose to an instant, as an angle in pixels of the panorama.
  [[nodiscard]] double moved_px(const Instant& instant,
                                const CameraPose& earlier_from_world) const {
    return projector_.moved_px(instant.world_from_camera, earlier_from_world);
  }

 private:
  /// Continuing the path of the pixel's last reprojection.
  [[nodiscard]] std::optional<Reprojection> continued(int x, int y,
                                                      const CameraPose& world_from_camera);

  PanoramaProjector projector_;
  ImageF columns_;  ///< of the last reprojections
};

}  // namespace saccade
