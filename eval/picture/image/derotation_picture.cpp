#include "eval/picture/image/derotation_picture.h"

namespace saccade {
namespace {

void draw(const Eigen::Vector2d& pixel, ImageF& counts) {
  if (is_inside(counts, pixel.x(), pixel.y())) splat(counts, pixel.x(), pixel.y(), 1.0F);
}

}  // namespace

ImageF count_events(std::span<const Event> events, const PinholeCamera& camera) {
  const UndistortionTable undistorted(camera);
  ImageF counts(camera.width, camera.height);
  for (const Event& event : events) draw(undistorted(event.x, event.y).cast<double>(), counts);
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
    const Eigen::Matrix3d reference_from_camera =
        reference_from_world *
        world_from_camera.at_clamped(seconds_from_ns(event.t_ns)).rotation_matrix();
    const Eigen::Vector3d ray =
        reference_from_camera * pinhole.ray(undistorted(event.x, event.y).cast<double>());
    if (ray.z() > 0) draw(pinhole.project(ray), counts);
  }
  return counts;
}

}  // namespace saccade
