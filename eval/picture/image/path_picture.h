#pragma once

#include <span>

#include "core/image.h"
#include "core/trajectory.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// The camera trajectory seen from above (x to the right, y up; world up is +z), with a scale bar:
/// the whole true trajectory as a broad line, over it the estimate up to a time. All pictures of
/// one object have the same scale.
class TopDownPath {
 public:
  /// Either trajectory may be empty. `width`, `height` [px].
  TopDownPath(const Trajectory& truth, const Trajectory& estimate, int width, int height,
              const Theme& theme);

  /// `marks`: positions in the world that are drawn as dots.
  [[nodiscard]] ImageRgb8 draw(double until_s, std::span<const Eigen::Vector3d> marks) const;

 private:
  [[nodiscard]] Eigen::Vector2d on_screen(const Eigen::Vector3d& position) const;

  Trajectory truth_, estimate_;
  int width_, height_;
  Theme theme_;
  Eigen::Vector2d centre_m_ = Eigen::Vector2d::Zero();
  double px_per_m_ = 1;
};

}  // namespace saccade
