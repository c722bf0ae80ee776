#include "estimator/odometry/edge_map.h"

#include <algorithm>
#include <utility>

namespace saccade {
void EdgeMap::add(Keyframe keyframe, const Rigid3& world_from_camera) {
  keyframes_.push_back(std::move(keyframe));
  const std::size_t newest = keyframes_.size() - 1;
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t i = 0; i < newest; ++i)
    others.emplace_back(visible_share(keyframes_[i], world_from_camera), i);
  std::stable_sort(others.begin(), others.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  active_ = {newest};
  for (const auto& [share, i] : others)
    if (active_.size() < static_cast<std::size_t>(options_.active) && share > 0)
      active_.push_back(i);
  std::sort(active_.begin(), active_.end());
  points_ = {};
  for (const std::size_t i : active_) append(points_, keyframes_[i].edges);
}

double EdgeMap::visible_share(const Keyframe& keyframe, const Rigid3& world_from_camera) const {
  constexpr std::size_t kProbes = 400;
  const MapPoints& edges = keyframe.edges;
  const std::size_t step = std::max<std::size_t>(1, edges.size() / kProbes);
  const Rigid3 camera_from_world = world_from_camera.inverse();
  double visible = 0, probes = 0;
  for (std::size_t i = 0; i < edges.size(); i += step, ++probes) {
    const Eigen::Vector3d point =
        camera_from_world * Eigen::Vector3d(edges.x[i], edges.y[i], edges.z[i]);
    if (point.z() > 0 && camera_.contains(camera_.project(point))) ++visible;
  }
  return probes > 0 ? visible / probes : 0;
}

}  // namespace saccade
