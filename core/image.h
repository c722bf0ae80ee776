#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/check.h"

namespace saccade {

/// A dense row-major image; (0, 0) is the centre of the top-left pixel, x right, y down.
template <class T>
class Image {
 public:
  Image() = default;
  /// `width`, `height` >= 0 [px].
  Image(int width, int height, T fill = T{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {
    SACCADE_CHECK(width >= 0 && height >= 0);
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

  [[nodiscard]] T& operator()(int x, int y) { return pixels_[index(x, y)]; }
  [[nodiscard]] const T& operator()(int x, int y) const { return pixels_[index(x, y)]; }

  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] std::span<T> pixels() { return pixels_; }
  [[nodiscard]] std::span<const T> pixels() const { return pixels_; }

  void fill(const T& value) { pixels_.assign(pixels_.size(), value); }

  [[nodiscard]] bool operator==(const Image&) const = default;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using ImageF = Image<float>;
using ImageU8 = Image<std::uint8_t>;
using Rgb8 = std::array<std::uint8_t, 3>;
using ImageRgb8 = Image<Rgb8>;

/// The four texels around a sub-pixel position and their bilinear weights (thesis A.2), which sum
/// to one. Valid for 0 <= x <= width - 1 and 0 <= y <= height - 1, borders included.
template <class Real>
struct BilinearCell {
  int x0, y0;
  Real fx, fy;

  BilinearCell(Real x, Real y, int width, int height)
      : x0(static_cast<int>(x)), y0(static_cast<int>(y)) {
    // On the last row or column the cell moves back by one, with weight one on its far side.
    if (x0 >= width - 1) x0 = width > 1 ? width - 2 : 0;
    if (y0 >= height - 1) y0 = height > 1 ? height - 2 : 0;
    fx = x - static_cast<Real>(x0);
    fy = y - static_cast<Real>(y0);
  }
};

/// True where sample() and splat() are defined.
template <class T, class Real>
[[nodiscard]] bool is_inside(const Image<T>& image, Real x, Real y) {
  return x >= 0 && y >= 0 && x <= static_cast<Real>(image.width() - 1) &&
         y <= static_cast<Real>(image.height() - 1);
}

template <class Real>
struct SampleWithGradient {
  Real value;
  Real dx, dy;  ///< [1/px], exact derivative of the bilinear interpolant
};

/// Bilinear interpolation with its derivative (thesis A.2). The image is at least 2 x 2; (x, y)
/// inside.
template <class T, class Real>
[[nodiscard]] SampleWithGradient<Real> sample_with_gradient(const Image<T>& image, Real x, Real y) {
  const BilinearCell<Real> c(x, y, image.width(), image.height());
  const T* row = &image(c.x0, c.y0);
  const Real a = static_cast<Real>(row[0]);
  const Real b = static_cast<Real>(row[1]);
  const Real d = static_cast<Real>(row[image.width()]);
  const Real e = static_cast<Real>(row[image.width() + 1]);
  const Real top = a + c.fx * (b - a);
  const Real bottom = d + c.fx * (e - d);
  return {top + c.fy * (bottom - top), (b - a) + c.fy * ((e - d) - (b - a)), bottom - top};
}

/// Bilinear interpolation (thesis A.2). The image is at least 2 x 2; (x, y) inside.
template <class T, class Real>
[[nodiscard]] Real sample(const Image<T>& image, Real x, Real y) {
  return sample_with_gradient(image, x, y).value;
}

/// Bilinear drawing (thesis A.3-A.7): adds `value` to the four pixels around (x, y), weights
/// summing to one. The image is at least 2 x 2; (x, y) inside.
template <class T, class Real>
void splat(Image<T>& image, Real x, Real y, T value) {
  const BilinearCell<Real> c(x, y, image.width(), image.height());
  T* row = &image(c.x0, c.y0);
  const Real wx = 1 - c.fx;
  const Real wy = 1 - c.fy;
  row[0] += static_cast<T>(wx * wy) * value;
  row[1] += static_cast<T>(c.fx * wy) * value;
  row[image.width()] += static_cast<T>(wx * c.fy) * value;
  row[image.width() + 1] += static_cast<T>(c.fx * c.fy) * value;
}

}  // namespace saccade
