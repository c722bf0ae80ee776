#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"

namespace saccade {

/// Depth-map propagation of the thesis (6.3): every known 3-D point is drawn into the camera with a
/// Gaussian of `size` x `size` pixels, D += K z, W += K, d = D / W (6.21). With a depth test: where
/// points of several depths meet, only those within 10 % of the nearest count.
class DepthSplat {
 public:
  /// `size`: odd, 1..99 [px]; sigma is a quarter of it. `points` in any one frame [m].
  DepthSplat(std::vector<Eigen::Vector3f> points, int size);

  /// 1 / d [1/m], 0 where no point reaches; `inverse_depth` has the size of `camera` (no lens).
  void draw(const Rigid3& camera_from_points, const PinholeCamera& camera,
            ImageF& inverse_depth) const;

 private:
  std::vector<Eigen::Vector3f> points_;
  int radius_;
  std::vector<float> kernel_;  ///< (2 radius + 1)^2
};

/// The points of a depth map, for DepthSplat.
[[nodiscard]] std::vector<Eigen::Vector3f> points_of(const ImageF& depth,
                                                     const PinholeCamera& camera);

}  // namespace saccade
