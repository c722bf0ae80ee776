#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/run/view_windows.h"

namespace saccade {

/// A point on an intensity edge with its depth, in the reference view of its window.
struct EdgePoint {
  float x_px = 0;  ///< undistorted pixel of the view, sub-pixel
  float y_px = 0;
  float inverse_depth = 0;  ///< 1 / z [1/m], > 0
  float sigma = 0;          ///< standard deviation of inverse_depth [1/m], > 0
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();  ///< unit, across the edge; 0: not known
  float pose_sigma = 0;  ///< of inverse_depth by the noise of the poses, alike for neighbours [1/m]
};

/// Depths that may occur [m], 0 < near < far; all that a method knows of the scene beforehand.
struct DepthLimits {
  double near_m = 0.5;
  double far_m = 50;

  [[nodiscard]] double min_inverse() const { return 1 / far_m; }
  [[nodiscard]] double max_inverse() const { return 1 / near_m; }
};

/// What a method found.
struct DepthResult {
  std::vector<EdgePoint> points;  ///< in the view at reference_s
  /// Pixels of the same view at which the method searched for depth, for pictures; every point is
  /// one of them or near one.
  std::vector<Eigen::Vector2f> candidates;
  std::vector<std::pair<std::string, double>>
      stages_s;  ///< time per stage, the same names in all windows
  /// By how much the gates of accuracy were opened to find enough points; 1: not at all.
  double gate_opening = 1;
  double event_delay_s =
      0;  ///< by how much the events came later than the poses, which was taken out
  std::string why_empty = {};  ///< of a view without points: what dropped its candidates
};

/// A method that estimates depths of edge points from events and poses. Too few events or too
/// little motion give few points or none, never an error.
class DepthEstimator {
 public:
  virtual ~DepthEstimator() = default;
  /// Thread-safe; the result depends on the window alone.
  [[nodiscard]] virtual DepthResult estimate(const ViewWindow& window) const = 0;
};

}  // namespace saccade
