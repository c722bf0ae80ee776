#include "simulator/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade {
namespace {

/// Two neighbouring texels and how far the position lies towards the second.
struct Neighbours {
  int first, second;
  double fraction;
};

Neighbours neighbours(double x, int size, Wrap wrap) {
  const double period = size;
  if (wrap == Wrap::kRepeat) {
    double inside = x - period * std::floor(x / period);
    if (inside >= period) inside = 0;  // a tiny negative x rounds up to the period
    const int first = static_cast<int>(inside);
    return {first, first + 1 == size ? 0 : first + 1, inside - first};
  }
  if (wrap == Wrap::kMirror) {
    const double edge = x + 0.5;  // mirrored about texel edges, not centres
    const double folded = edge - 2 * period * std::floor(edge / (2 * period));
    x = std::min(folded, 2 * period - folded) - 0.5;
  }
  const double inside = std::clamp(x, 0.0, period - 1);
  const int first = std::min(static_cast<int>(inside), size - 2);
  return {first, first + 1, inside - first};
}

/// Bilinear interpolation needs two texels each way.
ImageF widened(ImageF image) {
  if (image.width() >= 2 && image.height() >= 2) return image;
  ImageF wide(std::max(image.width(), 2), std::max(image.height(), 2));
  for (int y = 0; y < wide.height(); ++y)
    for (int x = 0; x < wide.width(); ++x)
      wide(x, y) = image(std::min(x, image.width() - 1), std::min(y, image.height() - 1));
  return wide;
}

}  // namespace

Texture::Texture(ImageF image, Wrap wrap_u, Wrap wrap_v)
    : image_(widened(std::move(image))), wrap_u_(wrap_u), wrap_v_(wrap_v) {
  SACCADE_CHECK(image_.width() >= 2 && image_.height() >= 2);
}

double Texture::across_border(double x, double y) const {
  const Neighbours column = neighbours(x, width(), wrap_u_);
  const Neighbours row = neighbours(y, height(), wrap_v_);
  const auto along = [&](int j) {
    const double a = image_(column.first, j);
    return a + column.fraction * (image_(column.second, j) - a);
  };
  const double top = along(row.first);
  return top + row.fraction * (along(row.second) - top);
}

}  // namespace saccade
