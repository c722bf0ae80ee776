#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// A root W of the information about a twist (v, w) of a camera whose image is known to move by
/// `sigma_px`, RMS, whatever is in view at half to twice the depth:
///   W^T W = mean over pixels and depths of J^T J / sigma^2,  J the image motion of the twist
/// (Longuet-Higgins and Prazdny, 1980). Motions that look alike are hardly distinguished.
[[nodiscard]] inline Matrix6 image_motion_sqrt_information(const PinholeCamera& camera,
                                                           double depth_m, double sigma_px) {
  constexpr int kGrid = 5;
  Matrix6 information = Matrix6::Zero();
  double count = 0;
  for (const double depth : {depth_m / 2, depth_m, 2 * depth_m})
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const Eigen::Vector3d ray = camera.ray(
            {(i + 0.5) / kGrid * camera.width - 0.5, (j + 0.5) / kGrid * camera.height - 0.5});
        Eigen::Matrix<double, 2, 6> motion;
        motion << Eigen::Matrix2d::Identity() / depth, -ray.head<2>() / depth,
            (Eigen::Matrix<double, 2, 3>() << -ray.x() * ray.y(), 1 + ray.x() * ray.x(), -ray.y(),
             -1 - ray.y() * ray.y(), ray.x() * ray.y(), ray.x())
                .finished();
        motion.row(0) *= camera.fx / sigma_px;
        motion.row(1) *= camera.fy / sigma_px;
        information += motion.transpose() * motion;
        ++count;
      }
  return (information / count).llt().matrixU();
}

}  // namespace saccade
