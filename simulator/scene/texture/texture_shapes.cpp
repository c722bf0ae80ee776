#include "simulator/scene/texture/texture_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/process/parallel.h"

namespace saccade {
namespace {

constexpr int kBandRows = 32;

/// Rows and columns that a shape may touch, cut to the image.
struct TexelArea {
  int x0, x1, y0, y1;  ///< the last ones included
};

TexelArea touched_area(const TextureShape& shape, float edge, const ImageF& image) {
  const auto reach = static_cast<double>(shape.reach + edge);
  const auto cut = [](double x, int last) {
    return static_cast<int>(std::clamp(std::floor(x), -1.0, static_cast<double>(last + 1)));
  };
  return {std::max(cut(shape.center.x() - reach, image.width() - 1), 0),
          std::min(cut(shape.center.x() + reach, image.width() - 1), image.width() - 1),
          std::max(cut(shape.center.y() - reach, image.height() - 1), 0),
          std::min(cut(shape.center.y() + reach, image.height() - 1), image.height() - 1)};
}

/// Signed distance to the border [texel], negative inside; outside near a corner a lower bound.
float distance_to_polygon(const TextureShape& shape, const Eigen::Vector2f& texel) {
  const Eigen::Vector2f offset = texel - shape.center;
  float farthest = -shape.reach;
  for (const Eigen::Vector3f& side : shape.sides)
    farthest = std::max(farthest, side.x() * offset.x() + side.y() * offset.y() - side.z());
  return farthest;
}

float distance_to_stroke(const TextureShape& shape, const Eigen::Vector2f& texel) {
  const Eigen::Vector2f offset = texel - shape.center;
  const float squared = shape.half_axis.squaredNorm();
  const float along =
      squared > 0 ? std::clamp(shape.half_axis.dot(offset) / squared, -1.0F, 1.0F) : 0.0F;
  return (offset - along * shape.half_axis).norm() - shape.half_width;
}

/// A leaf is what two discs of radius `arc_radius` have in common.
float distance_to_leaf(const TextureShape& shape, const Eigen::Vector2f& texel) {
  const Eigen::Vector2f offset = texel - shape.center;
  const Eigen::Vector2f across =
      Eigen::Vector2f(-shape.half_axis.y(), shape.half_axis.x()).normalized();
  const Eigen::Vector2f to_center = (shape.arc_radius - shape.half_width) * across;
  return std::max((offset - to_center).norm(), (offset + to_center).norm()) - shape.arc_radius;
}

template <class Distance>
void draw(ImageF& image, const TextureShape& shape, const Distance& distance, float edge,
          int first_row, int last_row) {
  const TexelArea area = touched_area(shape, edge, image);
  for (int y = std::max(area.y0, first_row); y <= std::min(area.y1, last_row); ++y) {
    float* row = &image(0, y);
    for (int x = area.x0; x <= area.x1; ++x) {
      const float d = distance(shape, {static_cast<float>(x), static_cast<float>(y)});
      if (d >= 0.5F * edge) continue;
      const float cover = shape.opacity * std::clamp(0.5F - d / edge, 0.0F, 1.0F);
      row[x] += cover * (shape.log_albedo - row[x]);
    }
  }
}

void draw(ImageF& image, const TextureShape& shape, float edge, int first_row, int last_row) {
  if (shape.arc_radius > 0)
    draw(image, shape, distance_to_leaf, edge, first_row, last_row);
  else if (shape.sides.empty())
    draw(image, shape, distance_to_stroke, edge, first_row, last_row);
  else
    draw(image, shape, distance_to_polygon, edge, first_row, last_row);
}

}  // namespace

void draw_shapes(ImageF& image, const std::vector<TextureShape>& shapes, float edge) {
  const int bands = (image.height() + kBandRows - 1) / kBandRows;
  std::vector<std::vector<std::uint32_t>> shapes_of_band(static_cast<std::size_t>(bands));
  for (std::uint32_t i = 0; i < shapes.size(); ++i) {
    const TexelArea area = touched_area(shapes[i], edge, image);
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
