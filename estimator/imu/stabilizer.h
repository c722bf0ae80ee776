#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// An event where a camera of constant orientation would have seen it.
struct StabilizedEvent {
  float x = 0, y = 0;  ///< undistorted, sub-pixel [px]; may lie outside the image
  Event source;        ///< as recorded
};

/// Warps events and images from the camera's orientation at their own time to another orientation,
///   u' = K R_(s,k) K^-1 u                                                                  (3.19)
/// and removes the lens distortion. Exact for distant scenes and for purely rotating cameras.
class Stabilizer {
 public:
  /// `camera` with its lens; `world_from_camera` is not empty and outlives this; its positions are
  /// ignored.
  Stabilizer(const PinholeCamera& camera, const Trajectory& world_from_camera);

  /// Warps every event by the orientation at its own time (thesis 3.3); beyond the trajectory's
  /// ends the orientation is held. `world_from_smoothed`: the orientation to warp to.
  [[nodiscard]] std::vector<StabilizedEvent> stabilize(
      std::span<const Event> events, const Eigen::Quaterniond& world_from_smoothed) const;

  /// Warps an image that was taken at `t_s`; 0 outside the camera's view.
  [[nodiscard]] ImageF stabilize(const ImageF& image, double t_s,
                                 const Eigen::Quaterniond& world_from_smoothed) const;

 private:
  PinholeCamera camera_;
  UndistortionTable undistortion_;
  const Trajectory& world_from_camera_;
};

}  // namespace saccade
