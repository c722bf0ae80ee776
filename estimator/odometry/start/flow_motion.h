#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/odometry/start/tile_flow.h"

namespace saccade {

constexpr std::size_t kLeastTiles = 10;

/// The motion of a camera that explains the flow of tiles, each at a depth of its own:
///   flow = B w + A v / z,   A = (-1, 0, x; 0, -1, y),
///   B = (x y, -1 - x^2, y; 1 + y^2, -x y, -x)   at the ray (x, y, 1), z > 0.
/// The unit of length is free: 1 / z of the tiles is 1 in the median.
struct FlowMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< v [typical depths/s]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      ///< w [rad/s]
  std::vector<double> inverse_depth;                   ///< of every tile
  double direction_deg = 180;  ///< within which v is known: four fifths of the resamples agree
  /// Motions whose directions are well apart from this one and from each other, to each of which at
  /// least two of the resamples lead; those of most resamples first. They have none in turn.
  std::vector<FlowMotion> others;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< w that alone explains the flow best
};

/// Between two vectors, 0 .. 180.
[[nodiscard]] double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Fits it by trying every direction of v (Heeger and Jepson, IJCV 1992, for flows of unequal
/// certainty): w and the depths follow from each by least squares. A wrong depth explains any speed of
/// an edge across itself, so what decides are tiles with edges of several directions. How well v is
/// known is found by drawing tiles with replacement. At least kLeastTiles tiles; deterministic.
/// Without `is_spread_asked` that is left out, most of the time: 180 degrees, and no others.
[[nodiscard]] FlowMotion fit_motion(std::span<const TileFlow> tiles, bool is_spread_asked = true);

}  // namespace saccade
