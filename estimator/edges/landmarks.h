#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/depth/rays/ray_gatherer.h"

namespace saccade {

/// A point on an edge that is known already.
struct Landmark {
  Eigen::Vector3d in_world;  ///< [m]
  double sigma = 0;          ///< of its depth, relative
};

/// Landmarks projected into a view, looked up by pixel.
class ProjectedLandmarks {
 public:
  struct Projection {
    Eigen::Vector2d pixel;
    double inverse_depth = 0;  ///< [1/m]
    double sigma = 0;          ///< [1/m]
    std::size_t index = 0;     ///< among the landmarks given
  };

  /// `camera` is undistorted.
  ProjectedLandmarks(std::span<const Landmark> landmarks, const Rigid3& view_from_world,
                     const PinholeCamera& camera);

  /// The one nearest to an edge, within `reach_px` of its pixel and within a relative `tolerance`
  /// of its inverse depth; nullptr for none.
  [[nodiscard]] const Projection* nearest(const Edgel& edge, double reach_px,
                                          double tolerance) const;

 private:
  static constexpr int kNone = -1;
  Image<int> first_;       ///< of each pixel
  std::vector<int> next_;  ///< of the same pixel
  std::vector<Projection> projections_;
};

}  // namespace saccade
