#include "eval/picture/overlay/depth_occlusion.h"

#include <algorithm>
#include <cmath>

#include "core/time_search.h"

namespace saccade {
namespace {

constexpr double kMinRelativeDistance = 0.01;
/// Times in text files are rounded to 1 ns.
constexpr double kTimeRoundingS = 2e-9;

double median_spacing_s(const std::vector<StampedFile>& files) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < files.size(); ++i) gaps.push_back(files[i].t_s - files[i - 1].t_s);
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

}  // namespace

bool is_occluded(const std::vector<PosedDepthMap>& maps, const Eigen::Vector3d& point_in_camera) {
  for (const PosedDepthMap& map : maps) {
    const Eigen::Vector3d point = map.map_from_camera * point_in_camera;
    if (!(point.z() > 0)) continue;
    const Eigen::Vector2d straight = map.camera.undistorted().project(point);
    const Eigen::Vector2d seen = map.camera.distort(straight);
    const Eigen::Vector2d pixel = seen.array().round();
    if (!map.camera.contains(pixel)) continue;
    // Far outside the image the distortion is not monotonic and may map back into it.
    if ((map.camera.undistort(seen) - straight).norm() > 1) continue;
    const float depth = map.depth(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    return depth > 0 && depth < (1 - kMinRelativeDistance) * point.z();
  }
  return false;
}

std::vector<PosedDepthMap> depth_maps_near(const Dataset& dataset, const Trajectory& motion,
                                           double t_s) {
  const std::vector<StampedFile>& maps = dataset.depth_maps();
  const auto after = static_cast<std::ptrdiff_t>(count_until(maps, t_s, &StampedFile::t_s));
  std::vector<std::size_t> near;
  const double max_distance_s = median_spacing_s(maps) + kTimeRoundingS;
  const auto add = [&](std::ptrdiff_t index) {
    if (index < 0 || index >= std::ssize(maps)) return;
    if (std::abs(maps[static_cast<std::size_t>(index)].t_s - t_s) <= max_distance_s)
      near.push_back(static_cast<std::size_t>(index));
  };
  add(after - 1);
  add(after);
  std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(maps[a].t_s - t_s) < std::abs(maps[b].t_s - t_s);
  });
  std::vector<PosedDepthMap> posed;
  const Rigid3 world_from_camera = motion.at_clamped(t_s);
  for (const std::size_t index : near)
    posed.push_back({dataset.load_depth(index), dataset.camera(),
                     motion.at_clamped(maps[index].t_s).inverse() * world_from_camera});
  return posed;
}

}  // namespace saccade
