#include "estimator/reconstruction/direction_places.h"

#include <algorithm>

namespace saccade {

DirectionPlaces::DirectionPlaces(const PinholeCamera& camera, const Panorama& panorama)
    : finder_(camera, panorama), columns_(camera.width, camera.height, finder_.middle()) {}

void DirectionPlaces::start(const Trajectory& world_from_camera, TimeNs t_ns) {
  end_ = {t_ns, pose_at(world_from_camera, Rigid3(), t_ns)};
}

void DirectionPlaces::advance(const Trajectory& world_from_camera, TimeNs last_ns) {
  begin_ = end_;
  start(world_from_camera, std::max(begin_.t_ns + 1, std::min(begin_.t_ns + kPoseStepNs, last_ns)));
}

std::optional<Place> DirectionPlaces::of(const Event& event) {
  const float share =
      static_cast<float>(event.t_ns - begin_.t_ns) / static_cast<float>(end_.t_ns - begin_.t_ns);
  return follow(event.x, event.y, between(begin_.world_from_camera, end_.world_from_camera, share));
}

std::optional<Place> DirectionPlaces::follow(int x, int y, const CameraPose& world_from_camera) {
  const auto place = finder_.find(x, y, world_from_camera, columns_(x, y));
  if (place) columns_(x, y) = place->x;
  return place;
}

}  // namespace saccade
