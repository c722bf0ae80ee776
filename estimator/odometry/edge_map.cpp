#include "estimator/odometry/edge_map.h"

#include <algorithm>
#include <utility>

namespace saccade {

void EdgeMap::add(Keyframe keyframe, const Rigid3& world_from_camera) {
  keyframes_.push_back(std::move(keyframe));
  activate_around(keyframes_.size() - 1, world_from_camera);
}

void EdgeMap::activate_around(std::size_t keyframe, const Rigid3& world_from_camera) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < keyframes_.size(); ++i)
    if (i != keyframe) others.push_back(i);
  std::vector<std::size_t> chosen = most_visible(std::move(others), world_from_camera);
  if (chosen.size() >= max_active_) chosen.pop_back();
  chosen.push_back(keyframe);
  std::sort(chosen.begin(), chosen.end());
  activate(std::move(chosen));
}

std::vector<std::size_t> EdgeMap::most_visible(std::vector<std::size_t> keyframes,
                                               const Rigid3& world_from_camera) const {
  std::vector<std::pair<double, std::size_t>> fractions;
  for (const std::size_t i : keyframes)
    if (const double fraction = visible_fraction(keyframes_[i], world_from_camera); fraction > 0)
      fractions.emplace_back(fraction, i);
  std::stable_sort(fractions.begin(), fractions.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  fractions.resize(std::min(fractions.size(), max_active_));
  keyframes.clear();
  for (const auto& [fraction, i] : fractions) keyframes.push_back(i);
  return keyframes;
}

std::vector<Landmark> EdgeMap::landmarks(double before_s, const Rigid3& world_from_camera) const {
  std::vector<std::size_t> older;
  for (std::size_t i = 0; i < keyframes_.size() && keyframes_[i].t_s < before_s; ++i)
    older.push_back(i);
  std::vector<Landmark> landmarks;
  for (const std::size_t i : most_visible(std::move(older), world_from_camera)) {
    const Keyframe& keyframe = keyframes_[i];
    for (const EdgePoint& point : keyframe.depth.points) {
      const double depth_m = 1 / static_cast<double>(point.inverse_depth);
      landmarks.push_back(
          {keyframe.world_from_camera * (depth_m * camera_.ray({point.x_px, point.y_px})),
           static_cast<double>(point.sigma) * depth_m});
    }
  }
  return landmarks;
}

void EdgeMap::activate(std::vector<std::size_t> keyframes) {
  active_ = std::move(keyframes);
  points_ = {};
  for (const std::size_t i : active_) append(points_, keyframes_[i].edges);
}

double EdgeMap::visible_fraction(const Keyframe& keyframe, const Rigid3& world_from_camera) const {
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
