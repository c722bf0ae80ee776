#pragma once

#include "core/image.h"

namespace saccade {

/// What a texture shows outside [0, 1]: itself again, its border, or itself mirrored.
enum class Wrap { kRepeat, kClamp, kMirror };

/// A grey picture in linear light with bilinear interpolation. Immutable and thread-safe.
class Texture {
 public:
  /// `image`: at least 1 x 1, linear light.
  explicit Texture(ImageF image, Wrap wrap_u = Wrap::kRepeat, Wrap wrap_v = Wrap::kRepeat);

  /// Texels across and down; a side of one texel is stored as two equal ones.
  [[nodiscard]] int width() const { return image_.width(); }
  [[nodiscard]] int height() const { return image_.height(); }
  [[nodiscard]] const ImageF& image() const { return image_; }
  [[nodiscard]] Wrap wrap_u() const { return wrap_u_; }
  [[nodiscard]] Wrap wrap_v() const { return wrap_v_; }

  /// Value at texel coordinates x = u W - 0.5, y = (1 - v) H - 0.5: texel (i, j) has its centre at
  /// (i, j). Any finite x, y below 1e15.
  [[nodiscard]] double at_texel(double x, double y) const {
    return is_inside(image_, x, y) ? sample(image_, x, y) : across_border(x, y);
  }

  /// Value at texture coordinates; texel (i, j) has its centre at u = (i + 0.5) / W,
  /// v = 1 - (j + 0.5) / H.
  [[nodiscard]] double at(double u, double v) const {
    return at_texel(u * width() - 0.5, (1 - v) * height() - 0.5);
  }

 private:
  [[nodiscard]] double across_border(double x, double y) const;

  ImageF image_;
  Wrap wrap_u_;
  Wrap wrap_v_;
};

}  // namespace saccade
