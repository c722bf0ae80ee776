#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/depth_estimator.h"

namespace saccade {

struct PlaneOptions {
  double radius_px = 7;
  /// Relative deviation of a surface from its tangent plane, added to the sigmas of the points.
  double model_error = 0.001;
};

/// The plane around a pixel.
struct LocalPlane {
  float inverse_depth = 0;  ///< at the pixel [1/m]
  float sigma = 0;          ///< of it, from those of the points [1/m]
  float weights = 0;        ///< sum over the points that it is fitted to
  float spread = 1;         ///< >= 1: robust scale of the points' residuals, in their sigmas
  Eigen::Vector2f slope = Eigen::Vector2f::Zero();  ///< of inverse depth [1/m per px]
};

/// Planes through the points around a pixel. The inverse depth of a plane is linear in the image,
///   rho(x) = rho_0 + g . (x - x_0),
/// fitted by weighted least squares with Tukey's biweight from a given value on, so that points beyond
/// a depth discontinuity have no weight.
class LocalPlanes {
 public:
  LocalPlanes(const std::vector<EdgePoint>& points, const PlaneOptions& options);

  /// Starts from the inverse depth of `start`, whose sigma bounds the points that may belong to the
  /// plane. Uses the points within the radius, one at `start` itself included. Not thread-safe.
  [[nodiscard]] LocalPlane fit(const EdgePoint& start);
  /// The same through the points within twice the area where few are within the radius, and no other
  /// surface is near: what few points have in common is the larger error there.
  [[nodiscard]] LocalPlane fit_widened(const EdgePoint& start);

  /// Whether points of the last fit's plane lie in each quadrant around its start: its depth there is
  /// interpolated then.
  [[nodiscard]] bool surrounds_start(const LocalPlane& plane) const;

  /// The side of an edge through the start of the last fit on which its surface lies: 1 that of the
  /// edge's normal, -1 the other; 0 where it continues on both, and where no surface farther away is
  /// found on the side that it leaves empty.
  [[nodiscard]] int surface_side(const EdgePoint& start, const LocalPlane& plane) const;

  /// Distance in inverse depth of the nearest other surface: of the neighbours that are not on the
  /// plane, the second nearest to it, since one alone may be wrong. Infinity without one.
  [[nodiscard]] float gap_around(float x_px, float y_px, const LocalPlane& plane) const {
    return gap_within(static_cast<float>(options_.radius_px), x_px, y_px, plane);
  }

  /// The point nearest to a pixel; nullptr where none is within the radius.
  [[nodiscard]] const EdgePoint* nearest(float x_px, float y_px) const;

 private:
  /// Weights on either side of an edge.
  struct Sides {
    float along = 0;    ///< on that of its normal
    float against = 0;  ///< on the other
  };

  /// Sums over the neighbours' weighted residuals, and the normal equations of the next plane.
  struct Sums {
    float weights, squares;
    Eigen::Matrix3d normal;
    Eigen::Vector3d right;
  };

  template <class Visit>
  void for_near(float x_px, float y_px, float radius, const Visit& visit) const;
  [[nodiscard]] float gap_within(float radius_px, float x_px, float y_px,
                                 const LocalPlane& plane) const;
  [[nodiscard]] LocalPlane fit_within(float radius_px, const EdgePoint& start);
  void gather(const EdgePoint& start, float radius_px);
  /// Robust scale of the neighbours' distances from the start's inverse depth, in their sigmas.
  [[nodiscard]] float spread_around_start();
  /// `plane`: change of inverse depth from the start, and slope.
  [[nodiscard]] Sums weighted_sums(const Eigen::Vector3f& plane, float spread) const;
  /// Biweight of a neighbour's distance from a plane; 0: it is not of it.
  [[nodiscard]] float weight_of(std::size_t neighbour, const LocalPlane& plane) const;
  [[nodiscard]] Sides plane_sides(const LocalPlane& plane, const Eigen::Vector2f& normal) const;
  [[nodiscard]] Sides behind_sides(const EdgePoint& start, const LocalPlane& plane) const;
  [[nodiscard]] int cell_of(float px, int cells) const;

  PlaneOptions options_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::size_t> begin_;  ///< of each cell in points_
  std::vector<EdgePoint> points_;   ///< by cells as wide as the radius

  // Neighbours of the last fit's start, padded to lanes.
  std::size_t count_ = 0;
  float start_inverse_depth_ = 0;
  std::vector<float> dx_, dy_;
  std::vector<float> difference_;  ///< of inverse depth from the start
  std::vector<float> per_sigma_;   ///< 0 behind `count_`
  std::vector<float> scratch_;
};

}  // namespace saccade
