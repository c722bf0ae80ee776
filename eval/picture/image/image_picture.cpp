#include "eval/picture/image/image_picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/srgb.h"

namespace saccade {
namespace {

/// `values` is reordered; not empty.
float percentile(std::vector<float>& values, double fraction) {
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A frame darker than this is left dark instead of showing its noise.
constexpr float kDarkest = 0.02F;

bool is_depth(float depth) { return depth > 0 && std::isfinite(depth); }

}  // namespace

ImageRgb8 draw_radiance(const ImageF& radiance) {
  std::vector<float> values(radiance.pixels().begin(), radiance.pixels().end());
  const float white = values.empty() ? 1 : std::max(kDarkest, percentile(values, 0.995));
  ImageRgb8 picture(radiance.width(), radiance.height());
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    const std::uint8_t code = srgb8_from_linear(radiance.pixels()[i] / white);
    picture.pixels()[i] = {code, code, code};
  }
  return picture;
}

DepthRange depth_range(const ImageF& depth) {
  std::vector<float> valid;
  for (const float z : depth.pixels())
    if (is_depth(z)) valid.push_back(z);
  if (valid.empty()) return {};
  const double near_m = percentile(valid, 0.01);
  const double far_m = percentile(valid, 0.99);
  return {near_m, std::max(far_m, near_m * 1.001)};
}

Rgb8 depth_colour(double depth_m, const DepthRange& range) {
  const double near_inverse = 1 / range.near_m;
  const double far_inverse = 1 / range.far_m;
  return ordered_colour((1 / depth_m - far_inverse) / (near_inverse - far_inverse));
}

ImageRgb8 draw_depth(const ImageF& depth, const DepthRange& range, const Theme& theme) {
  ImageRgb8 picture(depth.width(), depth.height(), theme.faint);
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (const float z = depth.pixels()[i]; is_depth(z))
      picture.pixels()[i] = depth_colour(z, range);
  return picture;
}

ImageF undistort_image(const ImageF& image, const PinholeCamera& camera, float outside) {
  if (!camera.is_distorted()) return image;
  ImageF result(image.width(), image.height(), outside);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Eigen::Vector2d seen = camera.distort(Eigen::Vector2d(x, y));
      if (is_inside(image, seen.x(), seen.y()))
        result(x, y) = static_cast<float>(sample(image, seen.x(), seen.y()));
    }
  return result;
}

}  // namespace saccade
