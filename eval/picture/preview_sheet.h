#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// One view of a scene with its caption.
struct PreviewPicture {
  std::string caption;
  ImageF radiance;  ///< linear light
};

/// A scene from above, x to the right and y up, with the camera's path and the poses of the views.
struct PlanPicture {
  ImageF radiance;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double px_per_m = 1;
  std::span<const StampedPose> path;
  std::vector<StampedPose> views;
};

/// Views in rows of four, all exposed alike, so that one can be compared with the next; below them
/// the plan: the path, and at every view a line along the optical axis.
[[nodiscard]] ImageRgb8 draw_preview(const std::string& title,
                                     std::span<const PreviewPicture> views, const PlanPicture& plan,
                                     const Theme& theme);

}  // namespace saccade
