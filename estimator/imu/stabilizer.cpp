#include "estimator/imu/stabilizer.h"

#include <cmath>

#include "core/check.h"
#include "core/rigid3.h"
#include "estimator/reconstruction/observations/pose_table.h"

namespace saccade {

Stabilizer::Stabilizer(const PinholeCamera& camera, const Trajectory& world_from_camera)
    : camera_(camera), undistortion_(camera), world_from_camera_(world_from_camera) {
  SACCADE_CHECK(!world_from_camera.empty());
}

std::vector<StabilizedEvent> Stabilizer::stabilize(
    std::span<const Event> events, const Eigen::Quaterniond& world_from_steady) const {
  std::vector<StabilizedEvent> stabilized;
  if (events.empty()) return stabilized;
  stabilized.reserve(events.size());
  const PoseTable table(world_from_camera_, Rigid3(world_from_steady.conjugate(), {0, 0, 0}),
                        events.front().t_ns, events.back().t_ns);
  const auto fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  for (const Event& event : events) {
    const Eigen::Vector2f& pixel = undistortion_(event.x, event.y);
    const Eigen::Vector3f ray((pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1);
    const Eigen::Vector3f turned = table.at(event.t_ns).r * ray;
    // What is behind the steady view is nowhere in its picture.
    const float scale = turned.z() > 0 ? 1 / turned.z() : std::nanf("");
    stabilized.push_back({fx * turned.x() * scale + cx, fy * turned.y() * scale + cy, event});
  }
  return stabilized;
}

ImageF Stabilizer::stabilize(const ImageF& picture, double t_s,
                             const Eigen::Quaterniond& world_from_steady) const {
  SACCADE_CHECK(picture.width() == camera_.width && picture.height() == camera_.height);
  const Eigen::Matrix3d camera_from_steady =
      (world_from_camera_.at_clamped(t_s).rotation().conjugate() * world_from_steady)
          .toRotationMatrix();
  ImageF stabilized(picture.width(), picture.height());
  for (int v = 0; v < picture.height(); ++v)
    for (int u = 0; u < picture.width(); ++u) {
      const Eigen::Vector3d ray = camera_from_steady * camera_.ray({u, v});
      if (!(ray.z() > 0)) continue;
      const Eigen::Vector2d from = camera_.distort(camera_.project(ray));
      if (!is_inside(picture, from.x(), from.y())) continue;
      stabilized(u, v) = static_cast<float>(sample(picture, from.x(), from.y()));
    }
  return stabilized;
}

}  // namespace saccade
