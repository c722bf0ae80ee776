#include "eval/picture/overlay/depth_occlusion.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr double kNearerBy = 0.01;
/// Times in text files are rounded to 1 ns.
constexpr double kTimeRoundingS = 2e-9;

double usual_spacing_s(const std::vector<StampedFile>& files) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < files.size(); ++i) gaps.push_back(files[i].t_s - files[i - 1].t_s);
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

}  // namespace

bool is_occluded(const std::vector<PosedDepthMap>& views, const Eigen::Vector3d& point_in_camera) {
  for (const PosedDepthMap& view : views) {
    const Eigen::Vector3d point = view.view_from_camera * point_in_camera;
    if (!(point.z() > 0)) continue;
    const Eigen::Vector2d straight = view.camera.undistorted().project(point);
    const Eigen::Vector2d seen = view.camera.distort(straight);
    const Eigen::Vector2d pixel = seen.array().round();
    if (!view.camera.contains(pixel)) continue;
    // Far outside the image the lens model folds over and may lead back into it.
    if ((view.camera.undistort(seen) - straight).norm() > 1) continue;
    const float depth = view.depth(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    return depth > 0 && depth < (1 - kNearerBy) * point.z();
  }
  return false;
}

std::vector<PosedDepthMap> depth_maps_near(const Dataset& dataset, const Trajectory& motion,
                                        double t_s) {
  const std::vector<StampedFile>& maps = dataset.depth_maps();
  const auto after = std::upper_bound(maps.begin(), maps.end(), t_s,
                                      [](double t, const StampedFile& map) { return t < map.t_s; });
  std::vector<std::size_t> near;
  const double reach_s = usual_spacing_s(maps) + kTimeRoundingS;
  const auto add = [&](std::ptrdiff_t index) {
    if (index < 0 || index >= std::ssize(maps)) return;
    if (std::abs(maps[static_cast<std::size_t>(index)].t_s - t_s) <= reach_s)
      near.push_back(static_cast<std::size_t>(index));
  };
  add(after - maps.begin() - 1);
  add(after - maps.begin());
  std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(maps[a].t_s - t_s) < std::abs(maps[b].t_s - t_s);
  });
  std::vector<PosedDepthMap> views;
  const Rigid3 world_from_camera = motion.at_clamped(t_s);
  for (const std::size_t index : near)
    views.push_back({dataset.load_depth(index), dataset.camera(),
                     motion.at_clamped(maps[index].t_s).inverse() * world_from_camera});
  return views;
}

}  // namespace saccade
