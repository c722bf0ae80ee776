#include "estimator/reconstruction/observations/panorama_reprojection.h"

#include <algorithm>

namespace saccade {

PanoramaReprojection::PanoramaReprojection(const PinholeCamera& camera, const Panorama& panorama)
    : projector_(camera, panorama), columns_(camera.width, camera.height, projector_.middle()) {}

void PanoramaReprojection::start(const Trajectory& world_from_camera, TimeNs t_ns) {
  end_ = {t_ns, pose_at(world_from_camera, Rigid3(), t_ns)};
}

void PanoramaReprojection::advance(const Trajectory& world_from_camera, TimeNs last_ns) {
  begin_ = end_;
  start(world_from_camera,
        std::max(begin_.t_ns + 1, std::min(begin_.t_ns + kPoseIntervalNs, last_ns)));
}

std::optional<Reprojection> PanoramaReprojection::of(const Event& event) {
  const float fraction =
      static_cast<float>(event.t_ns - begin_.t_ns) / static_cast<float>(end_.t_ns - begin_.t_ns);
  return follow(event.x, event.y,
                between(begin_.world_from_camera, end_.world_from_camera, fraction));
}

std::optional<Reprojection> PanoramaReprojection::follow(int x, int y,
                                                         const CameraPose& world_from_camera) {
  const auto reprojection = projector_.find(x, y, world_from_camera, columns_(x, y));
  if (reprojection) columns_(x, y) = reprojection->x;
  return reprojection;
}

}  // namespace saccade
