#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/trajectory.h"
#include "simulator/simulation_config.h"

namespace saccade {

/// What the first camera sees at one time, and how fast.
struct PreviewView {
  StampedPose pose;
  ImageF radiance;           ///< linear light
  double nearest_m = 0;      ///< smallest z depth; 0: background alone
  double median_m = 0;       ///< median z depth of what is not background; 0: background alone
  double flow_px_per_s = 0;  ///< median length of the motion field
  /// Events per second at that moment, to first order in time:
  ///   sum over pixels of |dL/dt| / C,   dL/dt = -grad L . v,   L = ln(eps + I)
  /// An edge before a background at rest counts half: its other half is a pixel of the background.
  double events_per_s = 0;
};

/// The scene seen from above by parallel rays that start at the height of the highest camera
/// position, so that ceilings are cut off. x to the right, y up.
struct PlanView {
  ImageF radiance;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double px_per_m = 1;
};

struct ScenePreview {
  std::vector<PreviewView> views;
  std::vector<StampedPose> path;
  PlanView plan;
};

/// Looks at a simulation before it is run: `views` >= 2 pictures at even times, and a plan of
/// `plan_px` x `plan_px` pixels around the path. Throws InputError as simulate() does.
[[nodiscard]] ScenePreview preview(const SimulationConfig& config, int views, int plan_px);

}  // namespace saccade
