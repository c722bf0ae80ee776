#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/io/images/image_file.h"

namespace saccade {

/// A picture with its halvings, for reading it at any size without aliasing. Colours are linear
/// light times alpha, so that transparent texels do not bleed into their neighbours.
class PicturePyramid {
 public:
  /// `picture`: sRGB codes with straight alpha, not empty (contract).
  explicit PicturePyramid(const ImageRgba8& picture);

  [[nodiscard]] int width() const { return levels_.front().width(); }
  [[nodiscard]] int height() const { return levels_.front().height(); }

  /// Red, green, blue (linear, times alpha) and alpha, 0..1, at texel (x, y) of the full picture;
  /// beyond the border its last texel. `footprint`: texels from one sample to the next; bilinear,
  /// between the two levels whose texels are nearest to it.
  [[nodiscard]] Eigen::Array4f sample(double x, double y, double footprint) const;

 private:
  using Level = Image<Eigen::Array4f>;

  [[nodiscard]] Eigen::Array4f sample_level(std::size_t level, double x, double y) const;

  std::vector<Level> levels_;
};

}  // namespace saccade
