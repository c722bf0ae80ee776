#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/image.h"
#include "core/panorama.h"
#include "estimator/reconstruction/level_system.h"

namespace saccade {

/// The pixels of the reference view as unknowns, `scale` of them per pixel and direction. A place
/// between pixels of several surfaces belongs to those that lie on the nearest pixel's, so that
/// nothing is mixed across the edge of an occluder. The pixels of a panorama are one surface, and
/// one that goes all around has a seam: there the first column follows the last one.
class ReferenceGrid {
 public:
  /// `inverse_depth` of every unknown [1/m], 0 = unknown; what differs by more than `same_surface`
  /// (a share) is another surface.
  ReferenceGrid(ImageF inverse_depth, int scale, double same_surface);
  explicit ReferenceGrid(const Panorama& panorama);

  [[nodiscard]] int width() const { return inverse_depth_.width(); }
  [[nodiscard]] int height() const { return inverse_depth_.height(); }
  [[nodiscard]] int scale() const { return scale_; }
  [[nodiscard]] const ImageF& inverse_depth() const { return inverse_depth_; }

  [[nodiscard]] bool wraps() const { return wraps_; }

  /// (x, y) in pixels of the view, within it; of one that wraps, x of any turn.
  [[nodiscard]] GridPoint at(float x, float y) const {
    if (wraps_) {
      x = in_first_turn(x);
      if (x > static_cast<float>(width() - 1)) return at_seam(x, y);
    }
    const auto scale = static_cast<float>(scale_);
    const BilinearCell<float> c(x * scale, y * scale, width(), height());
    const int first = c.y0 * width() + c.x0;
    GridPoint point{{first, first + 1, first + width(), first + width() + 1},
                    {(1 - c.fx) * (1 - c.fy), c.fx * (1 - c.fy), (1 - c.fx) * c.fy, c.fx * c.fy}};
    if (is_one_surface_(c.x0, c.y0) == 0) keep_one_surface(point);
    return point;
  }
  /// x of the same place from 0 to the width.
  [[nodiscard]] float in_first_turn(float x) const {
    const auto turn = static_cast<float>(width());
    return wraps_ ? x - turn * std::floor(x / turn) : x;
  }
  /// Index of the pixel nearest to a place.
  [[nodiscard]] std::size_t nearest(float x, float y) const {
    const int column = static_cast<int>(in_first_turn(x) + 0.5F);
    return static_cast<std::size_t>(static_cast<int>(y + 0.5F) * width() +
                                    (wraps_ && column >= width() ? column - width() : column));
  }
  /// The neighbours to the right and below; -1: there is none.
  [[nodiscard]] int right_of(int x, int y) const;
  [[nodiscard]] int below(int x, int y) const;
  /// The width of the pixels of a row against their height.
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
  ImageU8 is_one_surface_;  ///< all four of a pixel, the next ones right, below and right below
  int scale_;
  float same_surface_;
  bool wraps_ = false;
  std::vector<float> row_width_;  ///< empty: 1
};

}  // namespace saccade
