#include "simulator/sensor/image_renderer.h"

#include <algorithm>
#include <array>

#include "core/check.h"
#include "core/process/parallel.h"
#include "simulator/sensor/motion/image_motion.h"
#include "simulator/sensor/motion/object_motion.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade {
namespace {

/// One view of each row of a tile.
class RowViews {
 public:
  RowViews(std::span<const RowExposure> rows, const Tile& tile, std::size_t rays_per_pixel,
           std::size_t view)
      : tile_(tile),
        rays_per_pixel_(rays_per_pixel),
        rows_(
            rows.subspan(static_cast<std::size_t>(tile.y0), static_cast<std::size_t>(tile.height))),
        view_(view) {
    for (std::size_t y = 0; y < rows_.size(); ++y)
      rotations_[y] = rows_[y].poses[view].world_from_camera.rotation_matrix();
  }

  /// Of ray `k` of the tile.
  [[nodiscard]] const Eigen::Matrix3d& rotation(std::size_t k) const { return rotations_[row(k)]; }
  [[nodiscard]] Ray ray(std::size_t k, const Eigen::Vector3d& direction) const {
    const StampedPose& pose = rows_[row(k)].poses[view_];
    return {pose.world_from_camera.translation(), rotation(k) * direction, pose.t_s,
            rows_[row(k)].span_s};
  }

 private:
  [[nodiscard]] std::size_t row(std::size_t k) const {
    return static_cast<std::size_t>(tile_.y(k / rays_per_pixel_) - tile_.y0);
  }

  Tile tile_;
  std::size_t rays_per_pixel_;
  std::span<const RowExposure> rows_;
  std::size_t view_;
  std::array<Eigen::Matrix3d, kTileSize> rotations_;
};

}  // namespace

ImageRenderer::ImageRenderer(const Scene& scene, const PinholeCamera& camera, int rays_per_pixel,
                             TextureFilter filter, double side_px)
    : scene_(scene),
      filter_(filter),
      radiance_rays_(camera, rays_per_pixel, side_px),
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
        sums[k / per_pixel] += radiance_of(ray, triangle, rotation, rays[k]);
      };
      trace_tile(scene_, rays, pose, add, span_s);
    }
    for (std::size_t i = 0; i < tile.pixels(); ++i)
      image(tile.x(i), tile.y(i)) = static_cast<float>(sums[i] / count);
  };
  parallel_for(radiance_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

ImageF ImageRenderer::radiance(std::span<const RowExposure> rows) const {
  SACCADE_CHECK(rows.size() == static_cast<std::size_t>(camera().height));
  ImageF image(camera().width, camera().height);
  const std::size_t per_pixel = radiance_rays_.rays_per_pixel();
  const std::size_t views = rows.front().poses.size();
  const auto render = [&](std::size_t index) {
    const Tile tile = radiance_rays_.tile(index);
    const std::span<const Eigen::Vector3d> directions = radiance_rays_.rays(index);
    std::array<double, kTilePixels> sums{};
    for (std::size_t m = 0; m < views; ++m) {
      const RowViews row_views(rows, tile, per_pixel, m);
      for (std::size_t first = 0; first < directions.size(); first += kTilePixels) {
        const std::size_t n = std::min(kTilePixels, directions.size() - first);
        std::array<Ray, kTilePixels> rays;
        std::array<TriangleId, kTilePixels> triangles;
        for (std::size_t k = 0; k < n; ++k)
          rays[k] = row_views.ray(first + k, directions[first + k]);
        scene_.visible({rays.data(), n}, {triangles.data(), n});
        for (std::size_t k = 0; k < n; ++k)
          sums[(first + k) / per_pixel] += radiance_of(
              rays[k], triangles[k], row_views.rotation(first + k), directions[first + k]);
      }
    }
    for (std::size_t i = 0; i < tile.pixels(); ++i)
      image(tile.x(i), tile.y(i)) =
          static_cast<float>(sums[i] / static_cast<double>(per_pixel * views));
  };
  parallel_for(radiance_rays_.tile_count(), render, kTilesPerTask);
  return image;
}

double ImageRenderer::radiance_of(const Ray& ray, TriangleId triangle,
                                  const Eigen::Matrix3d& world_from_camera,
                                  const Eigen::Vector3d& direction) const {
  if (filter_ == TextureFilter::kBilinear) return scene_.shade(ray, triangle).radiance;
  return scene_
      .shade(ray, triangle, differential_in_world(radiance_rays_, world_from_camera, direction))
      .radiance;
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
          point_motion(camera(), rays[i], depth, twists.relative_to(ray, triangle, t_s));
      field.u(tile.x(i), tile.y(i)) = static_cast<float>(flow.x());
      field.v(tile.x(i), tile.y(i)) = static_cast<float>(flow.y());
    });
  };
  parallel_for(centre_rays_.tile_count(), render, kTilesPerTask);
  return field;
}

}  // namespace saccade
