#pragma once

#include <cstddef>
#include <optional>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/observations/reprojector.h"
#include "estimator/run/pose_table.h"

namespace saccade {

/// The reprojections of a sensor's pixels into a reference view whose depth is known, over time. A
/// pixel has one where the depth test finds no occluder, within the view. All pixels are followed
/// from one instant to the next, between which the image moves little and nearly straight; in between
/// reprojections are interpolated.
class SurfaceReprojection {
 public:
  /// `reference_inverse_depth`: of the reference view. All but the options outlive this.
  /// `max_motion_px`: most image motion from one instant to the next, beside a limit of 2 px.
  SurfaceReprojection(const PinholeCamera& camera, const DepthScene& scene,
                      const Rigid3& world_from_reference, const ImageF& reference_inverse_depth,
                      const ReprojectionOptions& options, double max_motion_px);

  void start(const Trajectory& world_from_camera, TimeNs t_ns);
  /// To the next instant, at most `last_ns`.
  void advance(const Trajectory& world_from_camera, TimeNs last_ns);

  /// Time and pose of the last instant.
  [[nodiscard]] TimeNs end_ns() const { return end_.t_ns; }
  [[nodiscard]] const CameraPose& end_pose() const { return end_.reference_from_camera; }

  /// Of an event between the last two instants.
  [[nodiscard]] std::optional<Reprojection> of(const Event& event) const;
  /// Of a pixel at the last instant.
  [[nodiscard]] std::optional<Reprojection> at_end(int x, int y) const {
    const std::size_t i = index_of(x, y);
    const ReprojectionField& at = end_.reprojections;
    if (!(at.inverse_depth[i] > 0)) return std::nullopt;
    return Reprojection{at.x[i], at.y[i], at.inverse_depth[i]};
  }
  /// Image motion from an earlier pose to the last instant, the maximum over a few points [px];
  /// infinity where one was behind the camera.
  [[nodiscard]] double moved_px(const CameraPose& earlier_from_reference) const {
    return projector_.moved_px(end_.reference_from_camera, earlier_from_reference);
  }

 private:
  /// All pixels at one time.
  struct Instant {
    TimeNs t_ns = 0;
    CameraPose reference_from_camera;
    ReprojectionField reprojections;
  };

  [[nodiscard]] std::size_t index_of(int x, int y) const {
    return static_cast<std::size_t>(y * width_ + x);
  }

  Reprojector projector_;
  Rigid3 reference_from_world_;
  int width_;
  double max_motion_px_;
  Instant begin_, end_;             ///< around the current events
  TimeNs interval_ns_ = 1'000'000;  ///< last interval between them
};

}  // namespace saccade
