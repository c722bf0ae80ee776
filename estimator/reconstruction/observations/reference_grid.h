#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/image.h"
#include "core/panorama.h"
#include "estimator/reconstruction/equations/intensity_system.h"

namespace saccade {

/// The pixels of the reference view as unknowns. A point between pixels of several surfaces belongs
/// to those on the surface of the nearest pixel, so that nothing is interpolated across an occluding
/// contour. The pixels of a panorama are one surface; one that covers a full revolution has a seam,
/// where the first column follows the last one.
class ReferenceGrid {
 public:
  /// `inverse_depth` of every pixel [1/m], 0 = unknown; pixels that differ by more than
  /// kSameSurfaceRatio are on different surfaces.
  explicit ReferenceGrid(ImageF inverse_depth);
  explicit ReferenceGrid(const Panorama& panorama);

  [[nodiscard]] int width() const { return inverse_depth_.width(); }
  [[nodiscard]] int height() const { return inverse_depth_.height(); }
  [[nodiscard]] const ImageF& inverse_depth() const { return inverse_depth_; }

  [[nodiscard]] bool wraps() const { return wraps_; }

  /// (x, y) in pixels of the view, within it; in one that wraps, x of any revolution.
  [[nodiscard]] GridPoint at(float x, float y) const {
    if (wraps_) {
      x = wrapped_x(x);
      if (x > static_cast<float>(width() - 1)) return at_seam(x, y);
    }
    const BilinearCell<float> c(x, y, width(), height());
    const int first = c.y0 * width() + c.x0;
    GridPoint point{{first, first + 1, first + width(), first + width() + 1},
                    {(1 - c.fx) * (1 - c.fy), c.fx * (1 - c.fy), (1 - c.fx) * c.fy, c.fx * c.fy}};
    if (is_one_surface_(c.x0, c.y0) == 0) keep_one_surface(point);
    return point;
  }
  /// x of the same point between 0 and the width.
  [[nodiscard]] float wrapped_x(float x) const {
    const auto period = static_cast<float>(width());
    return wraps_ ? x - period * std::floor(x / period) : x;
  }
  /// Index of the pixel nearest to a point.
  [[nodiscard]] std::size_t nearest(float x, float y) const {
    const int column = static_cast<int>(wrapped_x(x) + 0.5F);
    return static_cast<std::size_t>(static_cast<int>(y + 0.5F) * width() +
                                    (wraps_ && column >= width() ? column - width() : column));
  }
  /// The neighbours to the right and below; -1 without one.
  [[nodiscard]] int right_of(int x, int y) const;
  [[nodiscard]] int below(int x, int y) const;
  /// Width of the pixels of a row over their height.
  [[nodiscard]] float row_width(int y) const {
    return row_width_.empty() ? 1 : row_width_[static_cast<std::size_t>(y)];
  }
  /// Whether two unknowns lie on one surface.
  [[nodiscard]] bool is_joined(int i, int j) const;

 private:
  void keep_one_surface(GridPoint& point) const;
  /// Between the last column and the first one.
  [[nodiscard]] GridPoint at_seam(float x, float y) const;

  ImageF inverse_depth_;
  ImageU8 is_one_surface_;  ///< of a pixel and its neighbours right, below and right below
  bool wraps_ = false;
  std::vector<float> row_width_;  ///< empty: 1
};

}  // namespace saccade
