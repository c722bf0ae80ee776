#include "estimator/reconstruction/observations/surface_reprojection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade {
namespace {

// Between two instants, so that linear interpolation is accurate to a twentieth of a pixel.
constexpr double kMaxMotion_px = 2;
constexpr double kMaxBend_px = 0.05;
constexpr TimeNs kMinIntervalNs = 50'000;
constexpr TimeNs kMaxIntervalNs = 20'000'000;

}  // namespace

SurfaceReprojection::SurfaceReprojection(const PinholeCamera& camera, const DepthScene& scene,
                                         const Rigid3& world_from_reference,
                                         const ImageF& reference_inverse_depth,
                                         const ReprojectionOptions& options)
    : projector_(camera, scene, world_from_reference, reference_inverse_depth, options),
      reference_from_world_(world_from_reference.inverse()),
      width_(camera.width) {
  for (ReprojectionField& field : fields_) field.resize(reference_inverse_depth.size());
}

SurfaceReprojection::Instant SurfaceReprojection::first(const Trajectory& world_from_camera,
                                                        TimeNs t_ns) {
  Instant instant;
  instant.t_ns = t_ns;
  instant.reference_from_camera = pose_at(world_from_camera, reference_from_world_, t_ns);
  instant.surfaces = projector_.prepare(instant.reference_from_camera);
  return instant;
}

SurfaceReprojection::Instant SurfaceReprojection::next(const Instant& from,
                                                       const Trajectory& world_from_camera,
                                                       TimeNs last_ns) {
  Instant to;
  to.number = from.number + 1;
  CameraPose& pose = to.reference_from_camera;
  for (;;) {
    interval_ns_ = std::clamp(interval_ns_, kMinIntervalNs, kMaxIntervalNs);
    to.t_ns = std::max(from.t_ns + 1, std::min(from.t_ns + interval_ns_, last_ns));
    pose = pose_at(world_from_camera, reference_from_world_, to.t_ns);
    const CameraPose middle =
        pose_at(world_from_camera, reference_from_world_, from.t_ns + (to.t_ns - from.t_ns) / 2);
    const ImagePath motion =
        projector_.motion(from.reference_from_camera, inverse_of(middle), inverse_of(pose));
    const double ratio =
        std::max(motion.length / kMaxMotion_px, std::sqrt(motion.bend / kMaxBend_px));
    const auto length = static_cast<double>(to.t_ns - from.t_ns);
    interval_ns_ = static_cast<TimeNs>(length * std::clamp(0.95 / ratio, 0.25, 2.0));
    if (ratio <= 1 || to.t_ns - from.t_ns <= kMinIntervalNs) break;
  }
  to.surfaces = projector_.prepare(pose);
  return to;
}

void SurfaceReprojection::follow(const Instant& instant, PixelRows rows) {
  const auto now = static_cast<std::size_t>(instant.number % 2);
  projector_.follow(rows, instant.number, *instant.surfaces, instant.reference_from_camera,
                    fields_[1 - now], fields_[now]);
}

std::optional<Reprojection> SurfaceReprojection::of(const Event& event, const Instant& begin,
                                                    const Instant& end) const {
  const float fraction =
      static_cast<float>(event.t_ns - begin.t_ns) / static_cast<float>(end.t_ns - begin.t_ns);
  if (const auto reprojection = between(event.x, event.y, begin, end, fraction))
    return reprojection;
  return projector_.find(
      event.x, event.y, *end.surfaces,
      saccade::between(begin.reference_from_camera, end.reference_from_camera, fraction));
}

}  // namespace saccade
