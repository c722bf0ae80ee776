#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"

namespace saccade {

/// Side of the square of pixels that is traced as one packet [px], and its pixels.
constexpr int kTileSize = 4;
constexpr std::size_t kTilePixels = 16;
/// The same of squares about which much is found out once for all pixels: candidate triangles and
/// lights are nearly as many for a square of half the side.
constexpr int kLargeTileSize = 8;
constexpr std::size_t kMaxTilePixels = 64;
/// A task of parallel_for() takes so many tiles.
constexpr std::size_t kTilesPerTask = 16;

/// A square block of pixels; smaller at the right and lower border.
struct Tile {
  int x0 = 0, y0 = 0;
  int width = 0, height = 0;  ///< [px]

  [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(width * height); }
  [[nodiscard]] int x(std::size_t pixel) const { return x0 + static_cast<int>(pixel) % width; }
  [[nodiscard]] int y(std::size_t pixel) const { return y0 + static_cast<int>(pixel) / width; }
};

/// Directions (x, y, 1) in the camera frame of every pixel's rays, lens distortion removed once for
/// all, in tiles. The n x n rays of a pixel lie on a fixed pattern that is stratified in both axes
/// and along each of them (n = 2: the rotated grid), so that radiance stays a deterministic
/// function of the pose; one ray goes through the centre.
class PixelRays {
 public:
  /// `rays_per_pixel`: 1, 4 or 16. `side_px`: side of the square that a pixel sees, in units of
  /// the distance to the next pixel. `tile_size`: kTileSize or kLargeTileSize.
  PixelRays(const PinholeCamera& camera, int rays_per_pixel, double side_px = 1,
            int tile_size = kTileSize);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] std::size_t rays_per_pixel() const { return rays_per_pixel_; }

  /// Side of a tile [px].
  [[nodiscard]] int tile_size() const { return tile_size_; }
  [[nodiscard]] std::size_t tile_pixels() const {
    return static_cast<std::size_t>(tile_size_) * static_cast<std::size_t>(tile_size_);
  }
  [[nodiscard]] int tiles_x() const { return tiles_x_; }
  [[nodiscard]] int tiles_y() const { return tiles_y_; }
  [[nodiscard]] std::size_t tile_count() const {
    return static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  }
  /// Tiles are numbered row by row.
  [[nodiscard]] Tile tile(std::size_t index) const;

  /// Directions through the corners of tile `index`, `margin_px` outside it, in order around it.
  [[nodiscard]] std::array<Eigen::Vector3d, 4> outline(std::size_t index, double margin_px) const;

  /// Rays of tile `index`: pixel by pixel, row-major, each with all its rays.
  [[nodiscard]] std::span<const Eigen::Vector3d> rays(std::size_t index) const {
    return {&directions_[index * tile_pixels() * rays_per_pixel_],
            tile(index).pixels() * rays_per_pixel_};
  }

  /// How much `direction`, the ray of an image point, differs from those of the next rays to the
  /// right and below (columns: x and y of the camera frame), when each stands for its fraction of
  /// the pixel.
  [[nodiscard]] Eigen::Matrix2d differential(const Eigen::Vector3d& direction) const;

 private:
  PinholeCamera camera_;
  std::size_t rays_per_pixel_;
  double side_px_;
  int tile_size_;
  int tiles_x_, tiles_y_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace saccade
