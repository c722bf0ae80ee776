#pragma once

#include <cstddef>
#include <vector>

namespace saccade {

/// A float image with margins wide enough that a filter needs no special case at the border.
struct PaddedImage {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  int margin = 0;  ///< [px] on every side
  int stride = 0;  ///< [floats]
  std::vector<float> pixels;

  PaddedImage() = default;
  PaddedImage(int image_width, int image_height, int image_margin);

  [[nodiscard]] int rows() const { return height + 2 * margin; }
  [[nodiscard]] float* row(int y) { return pixels.data() + offset(y); }
  [[nodiscard]] const float* row(int y) const { return pixels.data() + offset(y); }
  void clear();

 private:
  [[nodiscard]] std::ptrdiff_t offset(int y) const {
    return static_cast<std::ptrdiff_t>(y + margin) * stride + margin;
  }
};

/// Separable Gaussian of size x size taps whose sum is one. Not thread-safe: it owns its scratch
/// row.
class GaussianBlur {
 public:
  /// `size` odd, 1..15 [px]; `sigma` > 0 [px].
  GaussianBlur(int size, double sigma);

  [[nodiscard]] int radius() const { return radius_; }

  /// Both images have the same size and margins >= radius(). The margins of `out` stay as they are.
  void apply(const PaddedImage& in, PaddedImage& out);

 private:
  int radius_;
  std::vector<float> taps_;  ///< centre first: w[0], w[1] = w[-1], ...
  std::vector<float> line_;  ///< one row after the vertical pass, with margins
};

}  // namespace saccade
