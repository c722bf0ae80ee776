#include "simulator/scene/texture_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"

namespace saccade {
namespace {

constexpr int kBandRows = 32;

/// Rows and columns that a shape may touch, cut to the image.
struct Extent {
  int x0, x1, y0, y1;  ///< the last ones included
};

Extent extent(const TextureShape& shape, float edge, const ImageF& image) {
  const auto reach = static_cast<double>(shape.reach + edge);
  const auto cut = [](double x, int last) {
    return static_cast<int>(std::clamp(std::floor(x), -1.0, static_cast<double>(last + 1)));
  };
  return {std::max(cut(shape.center.x() - reach, image.width() - 1), 0),
          std::min(cut(shape.center.x() + reach, image.width() - 1), image.width() - 1),
          std::max(cut(shape.center.y() - reach, image.height() - 1), 0),
          std::min(cut(shape.center.y() + reach, image.height() - 1), image.height() - 1)};
}

void draw(ImageF& image, const TextureShape& shape, float edge, int first_row, int last_row) {
  const Extent area = extent(shape, edge, image);
  for (int y = std::max(area.y0, first_row); y <= std::min(area.y1, last_row); ++y) {
    float* row = &image(0, y);
    for (int x = area.x0; x <= area.x1; ++x) {
      const float d = shape.distance({static_cast<float>(x), static_cast<float>(y)});
      const float cover = shape.opacity * std::clamp(0.5F - d / edge, 0.0F, 1.0F);
      row[x] += cover * (shape.log_albedo - row[x]);
    }
  }
}

}  // namespace

float TextureShape::distance(const Eigen::Vector2f& texel) const {
  const Eigen::Vector2f offset = texel - center;
  if (!sides.empty()) {
    float farthest = -reach;
    for (const Eigen::Vector3f& side : sides)
      farthest = std::max(farthest, side.head<2>().dot(offset) - side.z());
    return farthest;
  }
  const float squared = half_axis.squaredNorm();
  const float along = squared > 0 ? std::clamp(half_axis.dot(offset) / squared, -1.0F, 1.0F) : 0.0F;
  return (offset - along * half_axis).norm() - half_width;
}

void draw_shapes(ImageF& image, const std::vector<TextureShape>& shapes, float edge) {
  const int bands = (image.height() + kBandRows - 1) / kBandRows;
  std::vector<std::vector<std::uint32_t>> shapes_of_band(static_cast<std::size_t>(bands));
  for (std::uint32_t i = 0; i < shapes.size(); ++i) {
    const Extent area = extent(shapes[i], edge, image);
    if (area.x0 > area.x1 || area.y0 > area.y1) continue;
    for (int band = area.y0 / kBandRows; band <= area.y1 / kBandRows; ++band)
      shapes_of_band[static_cast<std::size_t>(band)].push_back(i);
  }
  parallel_for(shapes_of_band.size(), [&](std::size_t band) {
    const int first_row = static_cast<int>(band) * kBandRows;
    for (const std::uint32_t i : shapes_of_band[band])
      draw(image, shapes[i], edge, first_row, first_row + kBandRows - 1);
  });
}

}  // namespace saccade
