#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade {

/// An event where a camera would have seen it that did not turn.
struct StabilizedEvent {
  float x = 0, y = 0;  ///< undistorted, sub-pixel [px]; may lie outside the image
  Event source;        ///< as the sensor fired it
};

/// Turns what a camera saw at any time to where it would have seen it in another orientation,
///   u' = K R_(s,k) K^-1 u                                                                  (3.19)
/// with the lens taken out. Exact for what is far away, or where the camera only turns.
class Stabilizer {
 public:
  /// `camera` with its lens; `world_from_camera` is not empty and outlives this, positions do not
  /// matter.
  Stabilizer(const PinholeCamera& camera, const Trajectory& world_from_camera);

  /// Every event with the orientation at its own time (thesis 3.3), held beyond the trajectory's
  /// ends. `world_from_steady`: the orientation that they are turned to.
  [[nodiscard]] std::vector<StabilizedEvent> stabilize(
      std::span<const Event> events, const Eigen::Quaterniond& world_from_steady) const;

  /// A picture that was taken at `t_s`; 0 where the camera did not look.
  [[nodiscard]] ImageF stabilize(const ImageF& picture, double t_s,
                                 const Eigen::Quaterniond& world_from_steady) const;

 private:
  PinholeCamera camera_;
  UndistortionTable undistortion_;
  const Trajectory& world_from_camera_;
};

}  // namespace saccade
