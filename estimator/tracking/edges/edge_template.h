#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/edges/gaussian_blur.h"
#include "estimator/tracking/map_extraction.h"

namespace saccade {

/// How the map is drawn into the current view (thesis section 4.5).
struct TemplateOptions {
  /// A point is spread over its four pixels; without, it goes to the nearest one (the thesis),
  /// which moves it by up to half a pixel.
  bool bilinear = true;
  bool z_test = true;  ///< nearer points occlude farther ones; the thesis draws both
  int blur_size_px = 3;
  double blur_sigma_px = 0.8;
  /// Gradient of the blurred template [1/px] that a template point has: flat pixels say nothing
  /// about the pose.
  double min_gradient_px = 0.15;
  /// The template is kept until the view has moved this far: within it the linearisation holds.
  double redraw_px = 8;
};

/// Pixels of the blurred template above it are lit: what a point spreads over its neighbours.
inline constexpr float kMinTemplateValue = 0.01F;

/// One pixel of the blurred template. 32 bytes, so that one fits half a cache line.
struct alignas(32) TemplatePoint {
  Eigen::Vector2f ray;    ///< (x, y) of K^-1 u [-]
  float inverse_depth;    ///< [1/m], > 0
  float value;            ///< T(u), 0..1
  Eigen::Vector2f slope;  ///< (fx dT/du, fy dT/dv): gradient per unit of `ray` [-]
};

/// Draws template images from map points. Keeps its buffers, so a draw allocates nothing.
class TemplateDrawer {
 public:
  /// `camera` is undistorted; `options` are checked by describe().
  TemplateDrawer(const PinholeCamera& camera, const TemplateOptions& options, const MapPoints& map);
  /// Draws other points from now on; `map` outlives the drawer.
  void set_map(const MapPoints& map);
  /// Without a map, for draw_halved().
  TemplateDrawer(const PinholeCamera& camera, const TemplateOptions& options);

  /// Projects the map into the camera, keeps the nearer of two surfaces that meet in a pixel, blurs
  /// mask and mask * depth, and divides (4.20). The points come in row-major order; those on the
  /// border, whose gradient is unknown, are left out. Valid until the next draw.
  [[nodiscard]] std::span<const TemplatePoint> draw(const Rigid3& camera_from_map);

  /// For a drawer without a map, of half the size: the template is the last draw of `finer` in
  /// means of 2 x 2 pixels, blurred anew. Beyond the border it knows half of its own margin.
  [[nodiscard]] std::span<const TemplatePoint> draw_halved(const TemplateDrawer& finer);

  /// n_map: pixels of the last draw's template above kMinTemplateValue, whatever their gradient.
  [[nodiscard]] std::size_t lit_pixels() const { return lit_pixels_; }

  /// Of the last draw at a pixel of the image [1/m]; 0 where the template is dark.
  [[nodiscard]] float inverse_depth(int x, int y) const {
    const float mask = blurred_mask_.row(y)[x];
    return mask > kMinTemplateValue ? mask / blurred_depth_.row(y)[x] : 0;
  }

  /// The blurred template T of the last draw, for pictures.
  [[nodiscard]] const PaddedImage& image() const { return blurred_mask_; }

  /// What the points add up to in one pixel: mask and mask * depth side by side, as both are
  /// written together.
  struct Splat {
    float mask = 0;
    float depth = 0;
    void add(float weight, float z) {
      mask += weight;
      depth += weight * z;
    }
  };

 private:
  void project(const Rigid3& camera_from_map);
  void find_nearest();
  void splat_nearest();
  void splat_bilinear();
  void blur_and_collect();
  [[nodiscard]] std::size_t find_points(int y);
  void collect();

  PinholeCamera camera_;
  TemplateOptions options_;
  const MapPoints* map_;  ///< nullptr: none
  GaussianBlur blur_;
  /// Projected map points in pixels of the padded images (whose margins are drawn too, or the blur
  /// would see every edge end at the border), their depth [m], and the nearest pixel; -1 when not
  /// visible.
  std::vector<float> u_, v_, z_;
  std::vector<std::int32_t> pixel_;
  std::vector<Splat> splats_;  ///< of every pixel of the padded images
  PaddedImage nearest_;        ///< smallest depth per pixel [m], 0 = none
  PaddedImage mask_, depth_;   ///< mask, mask * depth
  PaddedImage blurred_mask_, blurred_depth_;
  std::vector<float> ray_x_;  ///< x of K^-1 u for every column
  /// One row of collect(): what passes (1 or 0), the differences across a pixel, and the columns of
  /// the template points.
  std::vector<std::uint8_t> is_point_;
  std::vector<float> gx_, gy_;
  std::vector<std::uint16_t> columns_;
  std::vector<TemplatePoint> points_;  ///< room for every pixel; the first point_count_ are in use
  std::size_t point_count_ = 0;
  std::size_t lit_pixels_ = 0;
};

}  // namespace saccade
