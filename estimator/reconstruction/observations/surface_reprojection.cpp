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
                                         const ReprojectionOptions& options, double max_motion_px)
    : projector_(camera, scene, world_from_reference, reference_inverse_depth, options),
      reference_from_world_(world_from_reference.inverse()),
      width_(camera.width),
      max_motion_px_(std::min(kMaxMotion_px, max_motion_px)) {
  begin_.reprojections.resize(reference_inverse_depth.size());
  end_.reprojections.resize(reference_inverse_depth.size());
}

void SurfaceReprojection::start(const Trajectory& world_from_camera, TimeNs t_ns) {
  end_.t_ns = t_ns;
  end_.reference_from_camera = pose_at(world_from_camera, reference_from_world_, t_ns);
  projector_.prepare(end_.reference_from_camera);
  std::fill(begin_.reprojections.inverse_depth.begin(), begin_.reprojections.inverse_depth.end(),
            0.0F);
  projector_.follow(end_.reference_from_camera, begin_.reprojections, end_.reprojections);
}

void SurfaceReprojection::advance(const Trajectory& world_from_camera, TimeNs last_ns) {
  std::swap(begin_, end_);
  CameraPose& pose = end_.reference_from_camera;
  for (;;) {
    interval_ns_ = std::clamp(interval_ns_, kMinIntervalNs, kMaxIntervalNs);
    end_.t_ns = std::max(begin_.t_ns + 1, std::min(begin_.t_ns + interval_ns_, last_ns));
    pose = pose_at(world_from_camera, reference_from_world_, end_.t_ns);
    const CameraPose middle = pose_at(world_from_camera, reference_from_world_,
                                      begin_.t_ns + (end_.t_ns - begin_.t_ns) / 2);
    const ImagePath motion =
        projector_.motion(begin_.reference_from_camera, inverse_of(middle), inverse_of(pose));
    const double ratio =
        std::max(motion.length / max_motion_px_, std::sqrt(motion.bend / kMaxBend_px));
    const auto length = static_cast<double>(end_.t_ns - begin_.t_ns);
    interval_ns_ = static_cast<TimeNs>(length * std::clamp(0.95 / ratio, 0.25, 2.0));
    if (ratio <= 1 || end_.t_ns - begin_.t_ns <= kMinIntervalNs) break;
  }
  projector_.prepare(pose);
  projector_.follow(pose, begin_.reprojections, end_.reprojections);
}

std::optional<Reprojection> SurfaceReprojection::of(const Event& event) const {
  const std::size_t i = index_of(event.x, event.y);
  const float fraction =
      static_cast<float>(event.t_ns - begin_.t_ns) / static_cast<float>(end_.t_ns - begin_.t_ns);
  const ReprojectionField& a = begin_.reprojections;
  const ReprojectionField& b = end_.reprojections;
  if (a.inverse_depth[i] > 0 && b.inverse_depth[i] > 0 &&
      std::abs(a.inverse_depth[i] - b.inverse_depth[i]) <=
          static_cast<float>(kSameSurfaceRatio) * a.inverse_depth[i])
    return Reprojection{a.x[i] + fraction * (b.x[i] - a.x[i]),
                        a.y[i] + fraction * (b.y[i] - a.y[i]),
                        a.inverse_depth[i] + fraction * (b.inverse_depth[i] - a.inverse_depth[i])};
  return projector_.find(
      event.x, event.y,
      between(begin_.reference_from_camera, end_.reference_from_camera, fraction));
}

}  // namespace saccade
