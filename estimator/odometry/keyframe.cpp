#include "estimator/odometry/keyframe.h"

namespace saccade {

void move_to(const Rigid3& world_from_camera, Keyframe& keyframe) {
  keyframe.edges =
      transformed(world_from_camera * keyframe.world_from_camera.inverse(), keyframe.edges);
  keyframe.world_from_camera = world_from_camera;
}

MapPoints points_in_world(const DepthResult& depth, const PinholeCamera& camera,
                          const Rigid3& world_from_camera, double max_sigma) {
  MapPoints points;
  for (const EdgePoint& point : depth.points) {
    if (!(point.sigma < static_cast<float>(max_sigma) * point.inverse_depth)) continue;
    const Eigen::Vector3d in_world = world_from_camera * (camera.ray({point.x_px, point.y_px}) /
                                                          static_cast<double>(point.inverse_depth));
    points.x.push_back(static_cast<float>(in_world.x()));
    points.y.push_back(static_cast<float>(in_world.y()));
    points.z.push_back(static_cast<float>(in_world.z()));
  }
  return points;
}

}  // namespace saccade
