#pragma once

#include "core/image.h"
#include "estimator/reconstruction/level_system.h"

namespace saccade {

/// The pixels of the reference view as unknowns, `scale` of them per pixel and direction. A place
/// between pixels of several surfaces belongs to those that lie on the nearest pixel's, so that
/// nothing is mixed across the edge of an occluder.
class ReferenceGrid {
 public:
  /// `inverse_depth` of every unknown [1/m], 0 = unknown; what differs by more than `same_surface`
  /// (a share) is another surface.
  ReferenceGrid(ImageF inverse_depth, int scale, double same_surface);

  [[nodiscard]] int width() const { return inverse_depth_.width(); }
  [[nodiscard]] int height() const { return inverse_depth_.height(); }
  [[nodiscard]] int scale() const { return scale_; }

  /// (x, y) in pixels of the view, within it.
  [[nodiscard]] GridPoint at(float x, float y) const {
    const auto scale = static_cast<float>(scale_);
    const BilinearCell<float> c(x * scale, y * scale, width(), height());
    const int first = c.y0 * width() + c.x0;
    GridPoint point{{first, first + 1, first + width(), first + width() + 1},
                    {(1 - c.fx) * (1 - c.fy), c.fx * (1 - c.fy), (1 - c.fx) * c.fy, c.fx * c.fy}};
    if (is_one_surface_(c.x0, c.y0) == 0) keep_one_surface(point);
    return point;
  }
  /// Whether two unknowns lie on one surface.
  [[nodiscard]] bool is_joined(int i, int j) const;

 private:
  void keep_one_surface(GridPoint& point) const;

  ImageF inverse_depth_;
  ImageU8 is_one_surface_;  ///< all four of a pixel, the next ones right, below and right below
  int scale_;
  float same_surface_;
};

}  // namespace saccade
