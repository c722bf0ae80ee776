#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "core/trajectory.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// The rays of a tile in the world and what they meet: `use(index, ray, triangle)`, in order.
/// `span_s`: as Ray has it.
template <class Use>
void trace_tile(const Scene& scene, std::span<const Eigen::Vector3d> directions,
                const StampedPose& pose, const Use& use, double span_s = 0) {
  const Eigen::Matrix3d rotation = pose.world_from_camera.rotation_matrix();
  const Eigen::Vector3d& origin = pose.world_from_camera.translation();
  std::array<Ray, kTilePixels> rays;
  std::array<TriangleId, kTilePixels> triangles;
  for (std::size_t first = 0; first < directions.size(); first += kTilePixels) {
    const std::size_t n = std::min(kTilePixels, directions.size() - first);
    for (std::size_t k = 0; k < n; ++k)
      rays[k] = {origin, rotation * directions[first + k], pose.t_s, span_s};
    scene.visible({rays.data(), n}, {triangles.data(), n});
    for (std::size_t k = 0; k < n; ++k) use(first + k, rays[k], triangles[k]);
  }
}

/// PixelRays::differential() of `direction` in the world.
[[nodiscard]] inline RayDifferential differential_in_world(const PixelRays& rays,
                                                           const Eigen::Matrix3d& world_from_camera,
                                                           const Eigen::Vector3d& direction) {
  const Eigen::Matrix<double, 3, 2> differential =
      world_from_camera.leftCols<2>() * rays.differential(direction);
  return {differential.col(0), differential.col(1)};
}

}  // namespace saccade
