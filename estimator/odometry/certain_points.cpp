#include "estimator/odometry/certain_points.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace saccade {
namespace {

constexpr std::size_t kColumns = 8, kRows = 6;
/// Points of one part of the view. Of nine tuning worlds 4, 8, 12 and 24 hold seven or eight:
/// single ones change by chance, and there is no trend.
constexpr std::size_t kEnough = 8;
/// Times the certain ones' sigma: what lies between that and nine times as much is the last resort.
constexpr double kLessCertain = 3;

std::size_t part_of(float at_px, int size_px, std::size_t parts) {
  const float part = at_px * static_cast<float>(parts) / static_cast<float>(size_px);
  return std::min(static_cast<std::size_t>(std::max(0.0F, part)), parts - 1);
}

}  // namespace

void keep_certain(const PinholeCamera& camera, double certain_sigma,
                  std::vector<EdgePoint>& points) {
  const auto cell_of = [&](const EdgePoint& point) {
    return part_of(point.y_px, camera.height, kRows) * kColumns +
           part_of(point.x_px, camera.width, kColumns);
  };
  const auto level_of = [&](const EdgePoint& point) -> std::size_t {
    const double sigma = static_cast<double>(point.sigma / point.inverse_depth);
    if (sigma < certain_sigma) return 0;
    return sigma < kLessCertain * certain_sigma ? 1 : 2;
  };
  // Of each cell, the points of each level and of the ones before it.
  std::array<std::array<std::size_t, 3>, kColumns * kRows> up_to{};
  for (const EdgePoint& point : points)
    for (std::size_t level = level_of(point); level < 3; ++level) ++up_to[cell_of(point)][level];
  std::erase_if(points, [&](const EdgePoint& point) {
    const std::size_t level = level_of(point);
    return level > 0 && up_to[cell_of(point)][level - 1] >= kEnough;
  });
}

}  // namespace saccade
