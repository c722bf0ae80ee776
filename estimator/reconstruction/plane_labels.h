#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "estimator/reconstruction/image_plane.h"

namespace saccade {

struct PlaneLabelOptions {
  double step_cost = 1;          ///< tau: of a pixel's length of a step of depth
  double full_step = 0.05;       ///< s: relative change of depth from which on it costs tau
  double hidden_cost = 1;        ///< most that a point behind the surface costs
  double outlier_cost = 6;       ///< most that a point in front of it costs
  double model_error = 0.003;    ///< of a surface from its planes, relative, added to sigma
  double nearness_cost = 0.02;   ///< n: of a pixel, per log inverse depth
  double reach_cost = 0.002;     ///< d: of a pixel, per pixel from the points on its plane
  double steepness_cost = 0.05;  ///< g: of a pixel, per log inverse depth per pixel
};

/// Which plane each pixel belongs to: the least of
///   sum over pixels  mean_k min(e_k^2 / 2, most_k) + n f + d distance + g |grad f|
///   + sum over neighbours a, b  tau w_ab min(1, (|f_a - f_b| at a + |f_a - f_b| at b) / 2 s)
/// with e_k the distance of a point in the pixel from its plane in sigmas, f the log inverse depth,
/// w_ab the length of border that a pair of eight neighbours stands for. Planes meet at a crease
/// for nothing, steps are short, what lies behind a surface may be hidden by it, and what is near
/// ends where its points do. Lowered by expansion moves (Boykov, Veksler and Zabih, PAMI 2001) with
/// OpenCV's maximum flow. Deterministic.
class PlaneLabels {
 public:
  /// Begins with the plane of the nearest anchor everywhere. `planes`: one per anchor, > 0 of them.
  PlaneLabels(int width, int height, std::span<const SurfaceAnchor> anchors,
              std::span<const ImagePlane> planes, const PlaneLabelOptions& options);

  /// Lets the plane take over any pixels, where that lowers the sum.
  void expand(const ImagePlane& plane);
  /// Only pixels within `reach_px` of (x, y), in x and y, and only if it suits points there better.
  void expand_near(const ImagePlane& plane, int x, int y, int reach_px);

  [[nodiscard]] float log_inverse_depth(int x, int y) const { return sheets_(x, y).value; }

 private:
  /// A plane at a pixel, to first order.
  struct Sheet {
    float value = 0;     ///< log inverse depth
    float x = 0, y = 0;  ///< its slope [1/px]
    float misfit = 0;    ///< cost of the pixel's points
    float cost = 0;      ///< of the pixel
  };
  /// An anchor as its pixel needs it.
  struct Point {
    float x_px, y_px;
    float value;        ///< log inverse depth
    float information;  ///< 1 / variance of it
  };
  struct Moves;

  void sort_by_pixel(std::span<const SurfaceAnchor> anchors);
  void spread(std::span<const SurfaceAnchor> anchors, std::span<const ImagePlane> planes);
  [[nodiscard]] Sheet sheet_of(const ImagePlane& plane, int x, int y) const;
  [[nodiscard]] float misfit_of(const Sheet& sheet, int x, int y) const;
  [[nodiscard]] Moves moves_of(const ImagePlane& plane, int left, int top, int right,
                               int bottom) const;
  [[nodiscard]] float gain_of(const Moves& moves) const;
  void make(Moves& moves);
  void add_reach(Moves& moves) const;
  void add_pairs(Moves& moves) const;
  [[nodiscard]] float step_cost(const Sheet& a, const Sheet& b, int dx, int dy) const;

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(sheets_.width()) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t pixel_of(const SurfaceAnchor& anchor) const;

  PlaneLabelOptions options_;
  float farthest_;  ///< log inverse depth of the farthest anchor
  Image<Sheet> sheets_;
  std::vector<Point> points_;         ///< by pixel
  std::vector<std::uint32_t> begin_;  ///< of each pixel's points
};

}  // namespace saccade
