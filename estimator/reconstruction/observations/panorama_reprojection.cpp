#include "estimator/reconstruction/observations/panorama_reprojection.h"

#include <algorithm>

namespace saccade {

PanoramaReprojection::PanoramaReprojection(const PinholeCamera& camera, const Panorama& panorama)
    : projector_(camera, panorama), columns_(camera.width, camera.height, projector_.middle()) {}

PanoramaReprojection::Instant PanoramaReprojection::next(const Instant& from,
                                                         const Trajectory& world_from_camera,
                                                         TimeNs last_ns) const {
  return first(world_from_camera,
               std::max(from.t_ns + 1, std::min(from.t_ns + kPoseIntervalNs, last_ns)));
}

std::optional<Reprojection> PanoramaReprojection::of(const Event& event, const Instant& begin,
                                                     const Instant& end) {
  const float fraction =
      static_cast<float>(event.t_ns - begin.t_ns) / static_cast<float>(end.t_ns - begin.t_ns);
  return between(event.x, event.y, begin, end, fraction);
}

std::optional<Reprojection> PanoramaReprojection::between(int x, int y, const Instant& begin,
                                                          const Instant& end, float fraction) {
  return continued(x, y,
                   saccade::between(begin.world_from_camera, end.world_from_camera, fraction));
}

std::optional<Reprojection> PanoramaReprojection::continued(int x, int y,
                                                            const CameraPose& world_from_camera) {
  const auto reprojection = projector_.find(x, y, world_from_camera, columns_(x, y));
  if (reprojection) columns_(x, y) = reprojection->x;
  return reprojection;
}

}  // namespace saccade
