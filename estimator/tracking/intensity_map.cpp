#include "estimator/tracking/intensity_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

/// Neighbours whose inverse depths differ by more than this fraction belong to two surfaces, unless
/// the next ones go on in the same way.
constexpr float kDepthDiscontinuity = 0.03F;

/// Difference of neighbours [log units] from which on they are an edge, not texture.
constexpr float kEdgeContrast = 0.9F;

/// Whether a row of inverse depths a, b, c, d belongs to one surface from b to c.
bool is_joined(float before, float b, float c, float after) {
  if (!(b > 0 && c > 0)) return false;
  const float step = std::abs(c - b);
  if (step <= kDepthDiscontinuity * std::max(b, c)) return true;
  const auto continues = [&](float difference) {
    return std::abs(difference - (c - b)) < 0.3F * step;
  };
  return before > 0 && after > 0 && continues(b - before) && continues(after - c);
}

/// Of every pixel, whether the square with its neighbours to the right and below is one surface.
std::vector<std::uint8_t> joined_squares(const std::vector<float>& inverse_depth, int width,
                                         int height) {
  const auto depth = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < width && y < height;
    return is_inside ? inverse_depth[static_cast<std::size_t>(y * width + x)] : 0;
  };
  const auto across = [&](int x, int y) {
    return is_joined(depth(x - 1, y), depth(x, y), depth(x + 1, y), depth(x + 2, y));
  };
  const auto down = [&](int x, int y) {
    return is_joined(depth(x, y - 1), depth(x, y), depth(x, y + 1), depth(x, y + 2));
  };
  std::vector<std::uint8_t> joined(inverse_depth.size());
  for (int y = 0; y + 1 < height; ++y)
    for (int x = 0; x + 1 < width; ++x)
      joined[static_cast<std::size_t>(y * width + x)] =
          across(x, y) && across(x, y + 1) && down(x, y) && down(x + 1, y) ? 1 : 0;
  return joined;
}

IntensityMap::View lift(const PinholeCamera& camera, const ReferenceView& reference,
                        const Rigid3& map_from_view, int first_row) {
  IntensityMap::View view;
  view.view_from_map = map_from_view.inverse();
  view.first_row = first_row;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float depth = reference.depth(x, y);
      const bool is_known = depth > 0 && std::isfinite(reference.log_intensity(x, y));
      const Eigen::Vector3d point =
          map_from_view * (camera.ray({x, y}) * static_cast<double>(is_known ? depth : 0));
      view.points.emplace_back(point.cast<float>());
      view.inverse_depth.push_back(is_known ? 1 / depth : 0);
    }
  view.is_joined = joined_squares(view.inverse_depth, camera.width, camera.height);
  return view;
}

/// A picture smoothed by a Gaussian; what is unknown stays so and counts for nothing.
ImageF smoothed(const ImageF& image, double blur_px) {
  const int reach = static_cast<int>(std::ceil(3 * blur_px));
  std::vector<double> kernel;
  for (int k = -reach; k <= reach; ++k)
    kernel.push_back(std::exp(-0.5 * k * k / (blur_px * blur_px)));
  const auto pass = [&](const ImageF& from, int dx, int dy) {
    ImageF to(from.width(), from.height());
    for (int y = 0; y < from.height(); ++y)
      for (int x = 0; x < from.width(); ++x) {
        double sum = 0;
        double weight = 0;
        for (int k = -reach; k <= reach; ++k) {
          const int u = x + k * dx;
          const int v = y + k * dy;
          if (u < 0 || v < 0 || u >= from.width() || v >= from.height()) continue;
          if (!std::isfinite(from(u, v))) continue;
          sum += kernel[static_cast<std::size_t>(k + reach)] * static_cast<double>(from(u, v));
          weight += kernel[static_cast<std::size_t>(k + reach)];
        }
        to(x, y) = std::isfinite(from(x, y)) ? static_cast<float>(sum / weight) : from(x, y);
      }
    return to;
  };
  return pass(pass(image, 1, 0), 0, 1);
}

/// Variance of the picture within half a pixel of each of its pixels, times 4: of bilinear values
/// under a Gaussian of sigma 0.5 px, per px^2. On a ramp it is the slope squared. What is unknown
/// counts for nothing.
ImageF local_variance(const ImageF& image) {
  // Weights of a 3 x 3 stencil with variance 0.25 px^2 along each axis.
  constexpr std::array<double, 3> kKernel{0.125, 0.75, 0.125};
  constexpr double kPerPixel = 4;
  ImageF variance(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      double weight = 0, sum = 0, squares = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int u = x + dx, v = y + dy;
          if (u < 0 || v < 0 || u >= image.width() || v >= image.height()) continue;
          if (!std::isfinite(image(u, v))) continue;
          const double k =
              kKernel[static_cast<std::size_t>(dx + 1)] * kKernel[static_cast<std::size_t>(dy + 1)];
          const auto value = static_cast<double>(image(u, v));
          weight += k;
          sum += k * value;
          squares += k * value * value;
        }
      if (weight > 0) {
        const double mean = sum / weight;
        variance(x, y) =
            static_cast<float>(kPerPixel * std::max(0.0, squares / weight - mean * mean));
      }
    }
  return variance;
}

/// The least and the greatest value of a pixel and its eight neighbours.
struct Extremes {
  ImageF least, greatest;
};
Extremes local_extremes(const ImageF& image) {
  Extremes found{image, image};
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int v = std::max(0, y - 1); v <= std::min(image.height() - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(image.width() - 1, x + 1); ++u) {
          // Comparisons with what is unknown are false.
          if (image(u, v) < found.least(x, y)) found.least(x, y) = image(u, v);
          if (image(u, v) > found.greatest(x, y)) found.greatest(x, y) = image(u, v);
        }
  return found;
}

/// Adds up, over the differences between neighbours that are an edge, which fraction they are of the
/// change that goes on to the next neighbours.
struct EdgeSharpness {
  double sum = 0;
  std::size_t edges = 0;

  void add(const ImageF& image, int dx, int dy) {
    for (int y = dy; y + 2 * dy < image.height(); ++y)
      for (int x = dx; x + 2 * dx < image.width(); ++x) {
        const float step = image(x + dx, y + dy) - image(x, y);
        if (!(std::abs(step) > kEdgeContrast)) continue;
        const float sign = step > 0 ? 1.0F : -1.0F;
        const float before = sign * (image(x, y) - image(x - dx, y - dy));
        const float after = sign * (image(x + 2 * dx, y + 2 * dy) - image(x + dx, y + dy));
        const float all = sign * step + std::max(before, 0.0F) + std::max(after, 0.0F);
        if (!std::isfinite(all)) continue;
        sum += static_cast<double>(sign * step / all);
        ++edges;
      }
  }
};

/// The largest difference between neighbours within two pixels.
ImageF steepness(const ImageF& image) {
  constexpr int kReach = 2;
  ImageF steepest(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      float most = 0;
      for (int v = std::max(0, y - kReach); v <= std::min(image.height() - 2, y + kReach - 1); ++v)
        for (int u = std::max(0, x - kReach); u <= std::min(image.width() - 2, x + kReach - 1);
             ++u) {
          const float right = std::abs(image(u + 1, v) - image(u, v));
          const float down = std::abs(image(u, v + 1) - image(u, v));
          most = std::max({most, right, down});
        }
      steepest(x, y) = most;
    }
  return steepest;
}

/// Where neighbours differ by more than kEdgeContrast the image is smoothed, fully from twice that on,
/// so that edges attract from further away; elsewhere it stays as it is.
ImageF smoothed_at_edges(const ImageF& image, double blur_px) {
  if (!(blur_px > 0)) return image;
  const ImageF blurred = smoothed(image, blur_px);
  const ImageF steep = steepness(image);
  ImageF result = image;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const float fraction = std::clamp(steep(x, y) / kEdgeContrast - 1, 0.0F, 1.0F);
      result(x, y) += fraction * (blurred(x, y) - image(x, y));
    }
  return result;
}

}  // namespace

IntensityMap::IntensityMap(const PinholeCamera& camera, std::span<const ReferenceView> views,
                           double edge_blur_px)
    : camera_(camera) {
  SACCADE_CHECK(!views.empty());
  world_from_map_ = views.front().world_from_reference;
  const int step = camera.height + 1;
  atlas_ = ImageF(camera.width, step * static_cast<int>(views.size()) - 1,
                  std::numeric_limits<float>::quiet_NaN());
  variance_ = ImageF(atlas_.width(), atlas_.height());
  least_ = greatest_ = atlas_;
  EdgeSharpness sharpness;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const int first_row = step * static_cast<int>(i);
    const ImageF picture = smoothed_at_edges(views[i].log_intensity, edge_blur_px);
    std::copy(picture.pixels().begin(), picture.pixels().end(), &atlas_(0, first_row));
    const ImageF variance = local_variance(views[i].log_intensity);
    std::copy(variance.pixels().begin(), variance.pixels().end(), &variance_(0, first_row));
    const Extremes extremes = local_extremes(views[i].log_intensity);
    std::copy(extremes.least.pixels().begin(), extremes.least.pixels().end(),
              &least_(0, first_row));
    std::copy(extremes.greatest.pixels().begin(), extremes.greatest.pixels().end(),
              &greatest_(0, first_row));
    sharpness.add(views[i].log_intensity, 1, 0);
    sharpness.add(views[i].log_intensity, 0, 1);
    views_.push_back(lift(camera, views[i],
                          world_from_map_.inverse() * views[i].world_from_reference, first_row));
  }
  constexpr std::size_t kEnough = 30;
  if (sharpness.edges >= kEnough)
    edge_sharpness_ = sharpness.sum / static_cast<double>(sharpness.edges);
}

}  // namespace saccade
