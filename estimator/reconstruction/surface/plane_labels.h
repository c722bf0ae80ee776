#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "estimator/reconstruction/surface/inverse_depth_plane.h"

namespace saccade {

/// Assigns a plane to each pixel: a minimum of
///   sum over pixels  mean_k min(e_k^2 / 2, most_k) + n f + d distance + g |grad f|
///   + sum over neighbours a, b  tau w_ab min(1, (|f_a - f_b| at a + |f_a - f_b| at b) / 2 s)
/// with e_k the distance of a point in the pixel from its plane in sigmas, f the log inverse depth,
/// w_ab the length of border that a pair of eight neighbours represents. Creases between planes cost
/// nothing, depth discontinuities cost their length, points behind a surface may be occluded by it,
/// and near surfaces end where their points do. Minimised by expansion moves (Boykov, Veksler and
/// Zabih, PAMI 2001) with OpenCV's maximum flow. Deterministic.
class PlaneLabels {
 public:
  /// Begins with the plane of the nearest anchor everywhere. `planes`: one per anchor, > 0 of them.
  PlaneLabels(int width, int height, std::span<const SurfaceAnchor> anchors,
              std::span<const InverseDepthPlane> planes);

  /// Assigns the plane to those pixels where that lowers the sum.
  void expand(const InverseDepthPlane& plane);
  /// Only pixels within `reach_px` of (x, y), in x and y, and only if it fits points there better.
  void expand_near(const InverseDepthPlane& plane, int x, int y, int reach_px);

  [[nodiscard]] float log_inverse_depth(int x, int y) const { return values_(x, y).value; }

 private:
  /// A plane at a pixel, to first order.
  struct PlaneValue {
    float value = 0;     ///< log inverse depth
    float x = 0, y = 0;  ///< its slope [1/px]
    float misfit = 0;    ///< cost of the pixel's points
    float cost = 0;      ///< of the pixel
  };
  /// An anchor, prepared for its pixel.
  struct Point {
    float x_px, y_px;
    float value;        ///< log inverse depth
    float information;  ///< 1 / variance of it
  };
  struct ExpansionMove;

  void sort_by_pixel(std::span<const SurfaceAnchor> anchors);
  void spread(std::span<const SurfaceAnchor> anchors, std::span<const InverseDepthPlane> planes);
  [[nodiscard]] PlaneValue value_of(const InverseDepthPlane& plane, int x, int y) const;
  [[nodiscard]] float misfit_of(const PlaneValue& value, int x, int y) const;
  [[nodiscard]] ExpansionMove move_of(const InverseDepthPlane& plane, int left, int top, int right,
                                      int bottom) const;
  [[nodiscard]] float gain_of(const ExpansionMove& move) const;
  void apply(ExpansionMove& move);
  void add_distance_cost(ExpansionMove& move) const;
  void add_pairs(ExpansionMove& move) const;
  [[nodiscard]] static float discontinuity_cost(const PlaneValue& a, const PlaneValue& b, int dx,
                                                int dy);

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(values_.width()) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t pixel_of(const SurfaceAnchor& anchor) const;

  float farthest_;  ///< log inverse depth of the farthest anchor
  Image<PlaneValue> values_;
  std::vector<Point> points_;         ///< by pixel
  std::vector<std::uint32_t> begin_;  ///< of each pixel's points
};

}  // namespace saccade
