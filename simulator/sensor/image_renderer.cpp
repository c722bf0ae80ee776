#include "simulator/sensor/image_renderer.h"

#include <algorithm>
#include <array>

#include "core/process/parallel.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/motion/object_motion.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade {

ImageRenderer::ImageRenderer(const Scene& scene, const PinholeCamera& camera, int rays_per_pixel,
                             TextureFilter filter)
    : scene_(scene),
      filter_(filter),
      radiance_rays_(camera, rays_per_pixel),
      centre_rays_(camera, 1) {}

ImageF ImageRenderer::radiance(std::span<const StampedPose> poses, double span_s) const {
  ImageF image(camera().width, camera().height);
  const std::size_t per_pixel = radiance_rays_.rays_per_pixel();
  const double count = static_cast<double>(per_pixel * poses.size());
  const auto render = [&](std::size_t index) {
    const Tile tile = radiance_rays_.tile(index);
    const std::span<const Eigen::Vector3d> rays = radiance_rays_.rays(index);
    std::array<double, kTilePixels> sums{};
    for (const StampedPose& pose : poses) {
      const Eigen::Matrix3d rotation = pose.world_from_camera.rotation_matrix();
      const auto add = [&](std::size_t k, const Ray& ray, TriangleId triangle) {
        sums[k / per_pixel] +=
            filter_ == TextureFilter::kBilinear
                ? scene_.shade(ray, triangle).radiance
                : scene_
                      .shade(ray, triangle,
                             differential_in_world(radiance_rays_, rotation, rays[k]))
                      .radiance;
      };
      trace_tile(scene_, rays, pose, add, span_s);
    }
    for (std::size_t i = 0; i < tile.pixels(); ++i)
      image(tile.x(i), tile.y(i)) = static_cast<float>(sums[i] / count);
  };
  parallel_for(radiance_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

ImageF ImageRenderer::depth(const StampedPose& pose) const {
  ImageF image(camera().width, camera().height);
  const auto render = [&](std::size_t index) {
    const Tile tile = centre_rays_.tile(index);
    trace_tile(scene_, centre_rays_.rays(index), pose,
               [&](std::size_t i, const Ray& ray, TriangleId triangle) {
                 image(tile.x(i), tile.y(i)) =
                     static_cast<float>(scene_.sample_surface(ray, triangle).distance);
               });
  };
  parallel_for(centre_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

FlowField ImageRenderer::flow(const SplineState& state, double t_s) const {
  FlowField field{ImageF(camera().width, camera().height), ImageF(camera().width, camera().height)};
  const StampedPose pose{t_s, state.world_from_body};
  const RelativeTwists twists(scene_, state, t_s);
  const auto render = [&](std::size_t index) {
    const Tile tile = centre_rays_.tile(index);
    const std::span<const Eigen::Vector3d> rays = centre_rays_.rays(index);
    trace_tile(scene_, rays, pose, [&](std::size_t i, const Ray& ray, TriangleId triangle) {
      const double depth = scene_.sample_surface(ray, triangle).distance;
      const Eigen::Vector2d flow =
          point_motion(camera(), rays[i], depth, twists.relative_to(triangle));
      field.u(tile.x(i), tile.y(i)) = static_cast<float>(flow.x());
      field.v(tile.x(i), tile.y(i)) = static_cast<float>(flow.y());
    });
  };
  parallel_for(centre_rays_.tile_count(), render, kTilesPerTask);
  return field;
}

}  // namespace saccade
