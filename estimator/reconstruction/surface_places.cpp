#include "estimator/reconstruction/surface_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace saccade {
namespace {

constexpr double kLongest_px = 2;  ///< between two moments at which all places are found
constexpr double kMostBend_px = 0.05;
constexpr TimeNs kShortestNs = 50'000;
constexpr TimeNs kLongestNs = 20'000'000;

}  // namespace

SurfacePlaces::SurfacePlaces(const PinholeCamera& camera, const DepthScene& scene,
                             const Rigid3& world_from_reference,
                             const ImageF& reference_inverse_depth, const PlaceOptions& options,
                             double longest_px)
    : finder_(camera, scene, world_from_reference, reference_inverse_depth, options),
      reference_from_world_(world_from_reference.inverse()),
      width_(camera.width),
      same_surface_(static_cast<float>(options.same_surface)),
      longest_px_(std::min(kLongest_px, longest_px)) {
  begin_.places.resize(reference_inverse_depth.size());
  end_.places.resize(reference_inverse_depth.size());
}

void SurfacePlaces::start(const Trajectory& world_from_camera, TimeNs t_ns) {
  end_.t_ns = t_ns;
  end_.reference_from_camera = pose_at(world_from_camera, reference_from_world_, t_ns);
  finder_.prepare(end_.reference_from_camera);
  std::fill(begin_.places.inverse_depth.begin(), begin_.places.inverse_depth.end(), 0.0F);
  finder_.follow(end_.reference_from_camera, begin_.places, end_.places);
}

void SurfacePlaces::advance(const Trajectory& world_from_camera, TimeNs last_ns) {
  std::swap(begin_, end_);
  CameraPose& pose = end_.reference_from_camera;
  for (;;) {
    length_ns_ = std::clamp(length_ns_, kShortestNs, kLongestNs);
    end_.t_ns = std::max(begin_.t_ns + 1, std::min(begin_.t_ns + length_ns_, last_ns));
    pose = pose_at(world_from_camera, reference_from_world_, end_.t_ns);
    const CameraPose middle = pose_at(world_from_camera, reference_from_world_,
                                      begin_.t_ns + (end_.t_ns - begin_.t_ns) / 2);
    const ViewShift motion =
        finder_.motion(begin_.reference_from_camera, inverse_of(middle), inverse_of(pose));
    const double share =
        std::max(motion.length / longest_px_, std::sqrt(motion.bend / kMostBend_px));
    const auto length = static_cast<double>(end_.t_ns - begin_.t_ns);
    length_ns_ = static_cast<TimeNs>(length * std::clamp(0.95 / share, 0.25, 2.0));
    if (share <= 1 || end_.t_ns - begin_.t_ns <= kShortestNs) break;
  }
  finder_.prepare(pose);
  finder_.follow(pose, begin_.places, end_.places);
}

std::optional<Place> SurfacePlaces::of(const Event& event) const {
  const std::size_t i = index_of(event.x, event.y);
  const float share =
      static_cast<float>(event.t_ns - begin_.t_ns) / static_cast<float>(end_.t_ns - begin_.t_ns);
  const PlaceField& a = begin_.places;
  const PlaceField& b = end_.places;
  if (a.inverse_depth[i] > 0 && b.inverse_depth[i] > 0 &&
      std::abs(a.inverse_depth[i] - b.inverse_depth[i]) <= same_surface_ * a.inverse_depth[i])
    return Place{a.x[i] + share * (b.x[i] - a.x[i]), a.y[i] + share * (b.y[i] - a.y[i]),
                 a.inverse_depth[i] + share * (b.inverse_depth[i] - a.inverse_depth[i])};
  return finder_.find(event.x, event.y,
                      between(begin_.reference_from_camera, end_.reference_from_camera, share));
}

}  // namespace saccade
