#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/depth/depth_estimator.h"

namespace saccade {

struct PlaneOptions {
  double radius_px = 7;
  int iterations = 4;
  double model_error = 0.001;  ///< of a surface from its tangent plane, relative, added to sigma
};

/// The plane around a pixel.
struct LocalPlane {
  float inverse_depth = 0;  ///< at the pixel [1/m]
  float sigma = 0;          ///< of it, from those of the points [1/m]
  float weights = 0;        ///< of the points that it rests on
  float spread = 1;  ///< >= 1: robust scale of the points' distances from it, in their sigmas
  Eigen::Vector2f slope = Eigen::Vector2f::Zero();  ///< of inverse depth [1/m per px]
};

/// Planes through the points around a pixel. The inverse depth of a plane is linear in the image,
///   rho(x) = rho_0 + g . (x - x_0),
/// fitted by weighted least squares with Tukey's biweight from a given value on, so that what lies
/// beyond a depth step has no say.
class LocalPlanes {
 public:
  LocalPlanes(const std::vector<EdgeDepth>& points, const PlaneOptions& options);

  /// From the inverse depth of `start` on, whose sigma says which points may belong to it. Points
  /// within the radius count, one at `start` itself included. Not thread-safe.
  [[nodiscard]] LocalPlane fit(const EdgeDepth& start);

  /// On which side of an edge through the start of the last fit() its surface lies: 1 on that of
  /// the edge's normal, -1 on the other; 0 where it goes on on both, and where no surface farther
  /// away is found on the side that it leaves empty.
  [[nodiscard]] int surface_side(const EdgeDepth& start, const LocalPlane& plane) const;

  /// Distance in inverse depth of the nearest other surface: of the points around that are not on
  /// the plane, the second nearest to it, since one alone may be wrong. Infinity where there is
  /// none.
  [[nodiscard]] float gap_around(float x_px, float y_px, const LocalPlane& plane) const;

  /// The point nearest to a pixel; nullptr where none is within the radius.
  [[nodiscard]] const EdgeDepth* nearest(float x_px, float y_px) const;

 private:
  /// What lies on either side of an edge.
  struct Sides {
    float along = 0;    ///< on that of its normal
    float against = 0;  ///< on the other
  };

  /// Of the neighbours' weighted residuals from a plane, and the normal equations of the next one.
  struct Sums {
    float weights, squares;
    Eigen::Matrix3d normal;
    Eigen::Vector3d right;
  };

  template <class Visit>
  void for_near(float x_px, float y_px, float radius, const Visit& visit) const;
  void gather(const EdgeDepth& start);
  /// Robust scale of the neighbours' distances from the start's own depth, in their sigmas.
  [[nodiscard]] float spread_around_start();
  /// `plane`: change of inverse depth from the start, and slope.
  [[nodiscard]] Sums weighted_sums(const Eigen::Vector3f& plane, float spread) const;
  [[nodiscard]] Sides plane_sides(const LocalPlane& plane, const Eigen::Vector2f& normal) const;
  [[nodiscard]] Sides behind_sides(const EdgeDepth& start, const LocalPlane& plane) const;
  [[nodiscard]] int cell_of(float px, int cells) const;

  PlaneOptions options_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::size_t> begin_;  ///< of each cell in points_
  std::vector<EdgeDepth> points_;   ///< by cells as wide as the radius

  // Neighbours of the pixel at hand, padded to lanes.
  std::size_t count_ = 0;
  float start_inverse_depth_ = 0;
  std::vector<float> dx_, dy_;
  std::vector<float> difference_;  ///< of inverse depth from the start
  std::vector<float> per_sigma_;   ///< 0 behind `count_`
  std::vector<float> scratch_;
};

}  // namespace saccade
