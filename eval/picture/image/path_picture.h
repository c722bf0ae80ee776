#pragma once

#include <span>

#include "core/image.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// The path of the camera seen from above (x to the right, y up, world up is +z), with a scale bar:
/// the whole truth as a broad line, over it the estimate as far as it has come. All pictures of one
/// path have the same scale.
class TopDownPath {
 public:
  /// Either path may be empty. `width`, `height` [px].
  TopDownPath(const Trajectory& truth, const Trajectory& estimate, int width, int height,
              const Theme& theme);

  /// `marks`: places in the world that get a dot each.
  [[nodiscard]] ImageRgb8 draw(double until_s, std::span<const Eigen::Vector3d> marks) const;

 private:
  [[nodiscard]] Eigen::Vector2d on_screen(const Eigen::Vector3d& place) const;

  Trajectory truth_, estimate_;
  int width_, height_;
  Theme theme_;
  Eigen::Vector2d centre_m_ = Eigen::Vector2d::Zero();
  double px_per_m_ = 1;
};

}  // namespace saccade
