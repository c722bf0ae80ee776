#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/odometry/start/plane_motion.h"
#include "estimator/rotation/warped_image.h"

namespace saccade {

/// How the picture moves in one tile of the sensor, in the middle of a window.
struct TileFlow {
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();   ///< (x, y, 1), the mean of its events
  Eigen::Vector2d flow = Eigen::Vector2d::Zero();  ///< d(x, y)/dt [1/s]
  /// Of `flow`, up to a factor that all tiles have in common: the curvature of the log contrast,
  /// times the number of events. Of parallel edges it has rank one.
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

/// The flow of every tile that holds events enough, as the constant velocity by which the tile's
/// image of warped events is sharpest. `motion`, of the middle of the window, says roughly how the
/// picture moves: flows farther than a few pixels over the window from it are not found. `events` of
/// the window, in order of time, at least one; `filter` with the camera's lens, `camera` without.
[[nodiscard]] std::vector<TileFlow> tile_flows(std::span<const Event> events, BurstFilter& filter,
                                               const PinholeCamera& camera,
                                               const PlaneMotion& motion);

}  // namespace saccade
