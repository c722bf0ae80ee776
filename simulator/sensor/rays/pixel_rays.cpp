#include "simulator/sensor/rays/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/check.h"
#include "simulator/sensor/motion/image_motion.h"

namespace saccade {
namespace {

/// Offsets from the pixel's centre [px]: the N-rooks arrangement of an n x n grid of strata, in
/// which no two rays share a column or a row of the n^2 x n^2 sub-grid.
std::vector<Eigen::Vector2d> ray_pattern(int rays_per_pixel) {
  const int n = rays_per_pixel == 1 ? 1 : rays_per_pixel == 4 ? 2 : 4;
  SACCADE_CHECK(n * n == rays_per_pixel);
  std::vector<Eigen::Vector2d> offsets;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      offsets.emplace_back((i + (j + 0.5) / n) / n - 0.5, (j + (i + 0.5) / n) / n - 0.5);
  return offsets;
}

}  // namespace

PixelRays::PixelRays(const PinholeCamera& camera, int rays_per_pixel, double side_px, int tile_size)
    : camera_(camera),
      rays_per_pixel_(static_cast<std::size_t>(rays_per_pixel)),
      side_px_(side_px),
      tile_size_(tile_size),
      tiles_x_((camera.width + tile_size - 1) / tile_size),
      tiles_y_((camera.height + tile_size - 1) / tile_size) {
  const std::vector<Eigen::Vector2d> pattern = ray_pattern(rays_per_pixel);
  directions_.resize(tile_count() * tile_pixels() * rays_per_pixel_);
  for (std::size_t index = 0; index < tile_count(); ++index) {
    const Tile block = tile(index);
    auto out =
        directions_.begin() + static_cast<std::ptrdiff_t>(index * tile_pixels() * rays_per_pixel_);
    for (std::size_t i = 0; i < block.pixels(); ++i) {
      const Eigen::Vector2d centre(block.x(i), block.y(i));
      for (const Eigen::Vector2d& offset : pattern)
        *out++ = camera.ray(camera.undistort(centre + side_px * offset));
    }
  }
}

std::array<Eigen::Vector3d, 4> PixelRays::outline(std::size_t index, double margin_px) const {
  const Tile block = tile(index);
  const double left = block.x0 - 0.5 - margin_px;
  const double top = block.y0 - 0.5 - margin_px;
  const double right = block.x0 + block.width - 0.5 + margin_px;
  const double bottom = block.y0 + block.height - 0.5 + margin_px;
  const auto corner = [&](double x, double y) { return camera_.ray(camera_.undistort({x, y})); };
  return {corner(left, top), corner(right, top), corner(right, bottom), corner(left, bottom)};
}

Tile PixelRays::tile(std::size_t index) const {
  Tile tile;
  tile.x0 = tile_size_ * (static_cast<int>(index) % tiles_x_);
  tile.y0 = tile_size_ * (static_cast<int>(index) / tiles_x_);
  tile.width = std::min(tile_size_, camera_.width - tile.x0);
  tile.height = std::min(tile_size_, camera_.height - tile.y0);
  return tile;
}

Eigen::Matrix2d PixelRays::differential(const Eigen::Vector3d& direction) const {
  const double side_px = side_px_ / std::sqrt(static_cast<double>(rays_per_pixel_));
  const Eigen::Matrix2d ideal_from_distorted =
      distortion_jacobian(camera_, camera_.project(direction)).inverse();
  return Eigen::Vector2d(1 / camera_.fx, 1 / camera_.fy).asDiagonal() *
         (side_px * ideal_from_distorted);
}

}  // namespace saccade
