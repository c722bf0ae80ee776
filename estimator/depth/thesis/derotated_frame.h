#pragma once

#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// Event frames without the camera's rotation (thesis 5.4): every event is rotated into the
/// orientation of the reference view with the pose at the event's time,
///   x = pi(R_k^-1 pi^-1(u_k, 1)),   R_k = R_k_r,                                            (5.15)
/// drawn bilinearly and counted without its polarity. Only the translational part of the motion is
/// left.
class Derotation {
 public:
  /// `trajectory` outlives this.
  Derotation(const PinholeCamera& camera, const UndistortionTable& undistortion,
             const Trajectory& trajectory, const Eigen::Quaterniond& world_from_reference);

  /// Events per pixel of the reference view, width x height of the sensor. Events that leave it are
  /// not drawn.
  [[nodiscard]] ImageF draw(std::span<const Event> events) const;

  /// From undistorted pixels at `t_s` to those of the reference orientation, homogeneous.
  [[nodiscard]] Eigen::Matrix3d homography(double t_s) const;

 private:
  void draw_chunk(std::span<const Event> chunk, ImageF& frame) const;

  PinholeCamera camera_;
  const UndistortionTable& undistortion_;
  const Trajectory& trajectory_;
  Eigen::Quaterniond reference_from_world_;
};

/// v <- log(1 + v), then divided by the root mean square, so that frames with different numbers of
/// events compare (thesis 5.4). A frame without events stays zero.
void normalise_frame(ImageF& frame);

}  // namespace saccade
