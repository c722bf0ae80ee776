#include "simulator/sensor/view.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "simulator/sensor/image_motion.h"
#include "simulator/sensor/object_motion.h"

namespace saccade {
namespace {

constexpr std::size_t kTilesPerTask = 16;

/// The rays of a tile in the world and what they meet: `use(index, ray, triangle)`.
template <class Use>
void trace_tile(const Scene& scene, std::span<const Eigen::Vector3d> directions,
                const StampedPose& pose, const Use& use) {
  const Eigen::Matrix3d rotation = pose.world_from_camera.rotation_matrix();
  const Eigen::Vector3d& origin = pose.world_from_camera.translation();
  std::array<Ray, kTilePixels> rays;
  std::array<TriangleId, kTilePixels> triangles;
  for (std::size_t first = 0; first < directions.size(); first += kTilePixels) {
    const std::size_t n = std::min(kTilePixels, directions.size() - first);
    for (std::size_t k = 0; k < n; ++k)
      rays[k] = {origin, rotation * directions[first + k], pose.t_s};
    scene.visible({rays.data(), n}, {triangles.data(), n});
    for (std::size_t k = 0; k < n; ++k) use(first + k, rays[k], triangles[k]);
  }
}

}  // namespace

ViewRenderer::ViewRenderer(const Scene& scene, const PinholeCamera& camera, int rays_per_pixel,
                           TextureFilter filter)
    : scene_(scene),
      filter_(filter),
      radiance_rays_(camera, rays_per_pixel),
      centre_rays_(camera, 1) {}

ImageF ViewRenderer::radiance(std::span<const StampedPose> poses) const {
  ImageF image(camera().width, camera().height);
  const std::size_t per_pixel = radiance_rays_.rays_per_pixel();
  const double count = static_cast<double>(per_pixel * poses.size());
  const auto render = [&](std::size_t index) {
    const Tile tile = radiance_rays_.tile(index);
    const std::span<const Eigen::Vector3d> rays = radiance_rays_.rays(index);
    std::array<double, kTilePixels> sums{};
    for (const StampedPose& pose : poses) {
      const Eigen::Matrix3d rotation = pose.world_from_camera.rotation_matrix();
      trace_tile(scene_, rays, pose, [&](std::size_t k, const Ray& ray, TriangleId triangle) {
        sums[k / per_pixel] +=
            filter_ == TextureFilter::kBilinear
                ? scene_.shade(ray, triangle).radiance
                : scene_.shade(ray, triangle, spread_in_world(rotation, rays[k])).radiance;
      });
    }
    for (std::size_t i = 0; i < tile.pixels(); ++i)
      image(tile.x(i), tile.y(i)) = static_cast<float>(sums[i] / count);
  };
  parallel_for(radiance_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

RaySpread ViewRenderer::spread_in_world(const Eigen::Matrix3d& world_from_camera,
                                        const Eigen::Vector3d& direction) const {
  const Eigen::Matrix<double, 3, 2> spread =
      world_from_camera.leftCols<2>() * radiance_rays_.spread(direction);
  return {spread.col(0), spread.col(1)};
}

ImageF ViewRenderer::depth(const StampedPose& pose) const {
  ImageF image(camera().width, camera().height);
  const auto render = [&](std::size_t index) {
    const Tile tile = centre_rays_.tile(index);
    trace_tile(scene_, centre_rays_.rays(index), pose,
               [&](std::size_t i, const Ray& ray, TriangleId triangle) {
                 image(tile.x(i), tile.y(i)) =
                     static_cast<float>(scene_.look(ray, triangle).distance);
               });
  };
  parallel_for(centre_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

FlowField ViewRenderer::flow(const SplineState& state, double t_s) const {
  FlowField field{ImageF(camera().width, camera().height), ImageF(camera().width, camera().height)};
  const StampedPose pose{t_s, state.world_from_body};
  const RelativeTwists twists(scene_, state, t_s);
  const auto render = [&](std::size_t index) {
    const Tile tile = centre_rays_.tile(index);
    const std::span<const Eigen::Vector3d> rays = centre_rays_.rays(index);
    trace_tile(scene_, rays, pose, [&](std::size_t i, const Ray& ray, TriangleId triangle) {
      const double depth = scene_.look(ray, triangle).distance;
      const Eigen::Vector2d flow = point_motion(camera(), rays[i], depth, twists.before(triangle));
      field.u(tile.x(i), tile.y(i)) = static_cast<float>(flow.x());
      field.v(tile.x(i), tile.y(i)) = static_cast<float>(flow.y());
    });
  };
  parallel_for(centre_rays_.tile_count(), render, kTilesPerTask);
  return field;
}

}  // namespace saccade
