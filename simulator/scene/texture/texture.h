#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/image.h"

namespace saccade {

/// Texel coordinates x0..x1 by y0..y1.
struct TexelBox {
  double x0, x1, y0, y1;
};

struct TexelRange {
  float low, high;
};

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

  /// The picture seen through a square of 2^level texels: trilinear in a pyramid of box-filtered
  /// pictures, continuous in all arguments; at level <= 0 the same as without one.
  [[nodiscard]] double at_texel(double x, double y, double level) const;

  /// The pictures of the pyramid, this one included. What this one has at x, picture k of
  /// W_k x H_k texels has (likewise in y) at
  ///   x_k = (x + 0.5) W_k / W - 0.5
  [[nodiscard]] std::size_t level_count() const { return coarser().size() + 1; }
  [[nodiscard]] const Texture& level(std::size_t k) const {
    return k == 0 ? *this : coarser()[k - 1];
  }

  /// Texels (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1), wrapped: between them at_texel() is
  /// bilinear.
  [[nodiscard]] std::array<float, 4> cell(std::int64_t i, std::int64_t j) const {
    if (i < 0 || j < 0 || i + 1 >= width() || j + 1 >= height()) return cell_across_border(i, j);
    const float* row = &image_(static_cast<int>(i), static_cast<int>(j));
    return {row[0], row[1], row[width()], row[width() + 1]};
  }

  /// Bounds of at_texel() over a box, tight up to a texel for small boxes and up to a quarter of
  /// the box for large ones (min-max pyramid).
  [[nodiscard]] TexelRange range(const TexelBox& box) const {
    const bool is_inside =
        box.x0 >= 0 && box.y0 >= 0 && box.x1 < width() - 1 && box.y1 < height() - 1;
    return is_inside ? range_within(static_cast<int>(box.x0), static_cast<int>(box.x1) + 1,
                                    static_cast<int>(box.y0), static_cast<int>(box.y1) + 1)
                     : range_across_border(box);
  }
  /// The same for at_texel(x, y, level) with levels `low_level` to `high_level`.
  [[nodiscard]] TexelRange range(const TexelBox& box, double low_level, double high_level) const;

 private:
  struct Pyramid;
  /// LogIntensities 1, 2 ... of the pyramid, made when they are first asked for.
  [[nodiscard]] const std::vector<Texture>& coarser() const;
  [[nodiscard]] double across_border(double x, double y) const;
  [[nodiscard]] std::array<float, 4> cell_across_border(std::int64_t i, std::int64_t j) const;
  [[nodiscard]] TexelRange range_across_border(const TexelBox& box) const;
  [[nodiscard]] TexelRange range_within(int i0, int i1, int j0, int j1) const;
  void build_ranges();

  ImageF image_;
  /// Extremes of blocks of 2 x 2, 4 x 4, 8 x 8 ... texels; the last level is one block.
  std::vector<Image<TexelRange>> ranges_;
  std::shared_ptr<Pyramid> pyramid_;  ///< shared by copies
  Wrap wrap_u_;
  Wrap wrap_v_;
};

}  // namespace saccade
