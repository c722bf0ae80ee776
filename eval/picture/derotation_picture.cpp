#include "eval/picture/derotation_picture.h"

#include <algorithm>

namespace saccade {
namespace {

void add_bilinear(const Eigen::Vector2d& pixel, ImageF& counts) {
  if (!is_inside(counts, pixel.x(), pixel.y())) return;
  const int x = static_cast<int>(pixel.x());
  const int y = static_cast<int>(pixel.y());
  const auto right = static_cast<float>(pixel.x() - x);
  const auto below = static_cast<float>(pixel.y() - y);
  const int next_x = std::min(x + 1, counts.width() - 1);
  const int next_y = std::min(y + 1, counts.height() - 1);
  counts(x, y) += (1 - right) * (1 - below);
  counts(next_x, y) += right * (1 - below);
  counts(x, next_y) += (1 - right) * below;
  counts(next_x, next_y) += right * below;
}

}  // namespace

ImageF count_events(std::span<const Event> events, const PinholeCamera& camera) {
  const UndistortionTable undistorted(camera);
  ImageF counts(camera.width, camera.height);
  for (const Event& event : events)
    add_bilinear(undistorted(event.x, event.y).cast<double>(), counts);
  return counts;
}

ImageF count_derotated_events(std::span<const Event> events, const PinholeCamera& camera,
                              const Trajectory& world_from_camera, double reference_s) {
  const UndistortionTable undistorted(camera);
  const PinholeCamera pinhole = camera.undistorted();
  const Eigen::Matrix3d reference_from_world =
      world_from_camera.at_clamped(reference_s).rotation_matrix().transpose();
  ImageF counts(camera.width, camera.height);
  for (const Event& event : events) {
    const Eigen::Matrix3d turn =
        reference_from_world *
        world_from_camera.at_clamped(seconds_from_ns(event.t_ns)).rotation_matrix();
    const Eigen::Vector3d ray = turn * pinhole.ray(undistorted(event.x, event.y).cast<double>());
    if (ray.z() > 0) add_bilinear(pinhole.project(ray), counts);
  }
  return counts;
}

}  // namespace saccade
