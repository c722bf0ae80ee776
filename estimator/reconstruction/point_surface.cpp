#include "estimator/reconstruction/point_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/reconstruction/level_system.h"

namespace saccade {
namespace {

constexpr int kRounds = 6;
constexpr double kLeastSigma = 0.003;  ///< of a point's relative depth
constexpr double kOutlier = 3;         ///< deviations beyond which a point counts less

/// A point on the map: its log inverse depth, so that near and far weigh alike.
struct Anchor {
  int index;
  float value;
  float sigma;
};

std::vector<Anchor> anchors_of(std::span<const SurfacePoint> points, const PinholeCamera& camera) {
  std::vector<Anchor> anchors;
  for (const SurfacePoint& point : points) {
    if (!(point.position.z() > 0)) continue;
    const Eigen::Vector2d pixel = camera.project(point.position);
    if (!camera.contains(pixel)) continue;
    const auto x = static_cast<int>(std::lround(pixel.x()));
    const auto y = static_cast<int>(std::lround(pixel.y()));
    anchors.push_back({y * camera.width + x, static_cast<float>(-std::log(point.position.z())),
                       static_cast<float>(std::max(point.relative_sigma, kLeastSigma))});
  }
  return anchors;
}

void add_anchors(LevelSystem& system, const std::vector<Anchor>& anchors, const ImageF& map) {
  for (const Anchor& anchor : anchors) {
    float weight = 1 / (anchor.sigma * anchor.sigma);
    if (!map.empty()) {
      const float error = map.pixels()[static_cast<std::size_t>(anchor.index)] - anchor.value;
      const float share = error / (static_cast<float>(kOutlier) * anchor.sigma);
      weight /= 1 + share * share;
    }
    system.add_value(anchor.index, anchor.value, weight);
  }
}

/// |d| as d^2 / |d before|, for every pair of neighbours.
void add_variation(LevelSystem& system, const PinholeCamera& camera, const ImageF& map,
                   double smoothness) {
  const auto least = static_cast<float>(smoothness * smoothness);
  const auto add = [&](int i, int j) {
    const float difference = map.empty() ? 0
                                         : map.pixels()[static_cast<std::size_t>(i)] -
                                               map.pixels()[static_cast<std::size_t>(j)];
    system.add_smooth(i, j, 1 / (least + static_cast<float>(smoothness) * std::abs(difference)));
  };
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const int i = y * camera.width + x;
      if (x + 1 < camera.width) add(i, i + 1);
      if (y + 1 < camera.height) add(i, i + camera.width);
    }
}

}  // namespace

ImageF surface_through(std::span<const SurfacePoint> points, const PinholeCamera& camera,
                       double smoothness) {
  const std::vector<Anchor> anchors = anchors_of(points, camera);
  ImageF map;
  if (anchors.empty()) return {camera.width, camera.height};
  for (int round = 0; round < kRounds; ++round) {
    LevelSystem system(camera.width, camera.height);
    add_anchors(system, anchors, map);
    add_variation(system, camera, map, smoothness);
    map = system.solve(60, 1e-3, map).image;
  }
  for (float& value : map.pixels()) value = std::exp(-value);
  return map;
}

}  // namespace saccade
