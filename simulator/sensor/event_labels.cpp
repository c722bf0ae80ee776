#include "simulator/sensor/event_labels.h"

#include <algorithm>
#include <array>

#include "core/process/parallel.h"
#include "simulator/scene/moving_object.h"
#include "simulator/sensor/motion/image_motion.h"

namespace saccade {
namespace {

constexpr std::size_t kPacketsPerTask = 64;

/// The direction of the ray through a pixel's centre.
const Eigen::Vector3d& centre_ray(const PixelRays& rays, const SensedEvent& event) {
  const int tile = event.y / kTileSize * rays.tiles_x() + event.x / kTileSize;
  const auto index = static_cast<std::size_t>(tile);
  const Tile block = rays.tile(index);
  const int pixel = (event.y - block.y0) * block.width + event.x - block.x0;
  return rays.rays(index)[static_cast<std::size_t>(pixel)];
}

}  // namespace

EventLabeller::EventLabeller(const Scene& scene, const Spline& world_from_camera,
                             const PinholeCamera& camera)
    : scene_(scene), motion_(world_from_camera), rays_(camera, 1) {}

EventLabels EventLabeller::label(std::span<const SensedEvent> events) const {
  EventLabels labels;
  labels.resize(events.size());
  const std::size_t packets = (events.size() + kTilePixels - 1) / kTilePixels;
  parallel_for(
      packets, [&](std::size_t k) { label_packet(events, k * kTilePixels, labels); },
      kPacketsPerTask);
  return labels;
}

void EventLabeller::label_packet(std::span<const SensedEvent> events, std::size_t first,
                                 EventLabels& labels) const {
  const std::size_t count = std::min(kTilePixels, events.size() - first);
  std::array<Ray, kTilePixels> rays;
  std::array<SplineState, kTilePixels> states;
  std::array<TriangleId, kTilePixels> triangles;
  for (std::size_t k = 0; k < count; ++k) {
    const double t_s = seconds_from_ns(events[first + k].t_ns);
    states[k] = motion_.state(t_s);
    const Rigid3& pose = states[k].world_from_body;
    rays[k] = {pose.translation(), pose.rotation() * centre_ray(rays_, events[first + k]), t_s};
  }
  scene_.visible({rays.data(), count}, {triangles.data(), count});
  for (std::size_t k = 0; k < count; ++k) {
    const SensedEvent& event = events[first + k];
    const std::size_t i = first + k;
    const double depth = scene_.sample_surface(rays[k], triangles[k]).distance;
    const MovingObject* object = scene_.moving_object(triangles[k]);
    Twist twist = object == nullptr ? camera_twist(states[k])
                                    : relative_twist(states[k], object->state(rays[k].time_s));
    if (object != nullptr && object->animation() != nullptr)
      twist.head<3>() -= states[k].world_from_body.rotation().conjugate() *
                         scene_.deformation_velocity(rays[k], triangles[k], rays[k].time_s);
    const Eigen::Vector2d flow =
        point_motion(rays_.camera(), centre_ray(rays_, event), depth, twist);
    labels.depth[i] = static_cast<float>(depth);
    labels.flow_x[i] = static_cast<float>(flow.x());
    labels.flow_y[i] = static_cast<float>(flow.y());
    labels.object[i] =
        triangles[k] == kNothing ? -1 : static_cast<std::int32_t>(scene_.object(triangles[k]));
    labels.instance[i] = scene_.instance(triangles[k]);
    labels.class_id[i] = scene_.class_of(labels.instance[i]);
    labels.origin[i] = static_cast<std::uint8_t>(event.origin);
  }
}

}  // namespace saccade
