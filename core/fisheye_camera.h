#pragma once

#include <array>
#include <string>

#include "core/camera.h"

namespace saccade {

/// Kannala-Brandt camera with four coefficients (IEEE PAMI 28(8), 2006), basalt's kb4 and OpenCV's
/// fisheye: with theta = atan(r) the angle of the ray (x, y, 1), r = |(x, y)|,
///   d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8),  u = fx x d / r + cx.
struct FisheyeCamera {
  int width = 0;                          ///< [px]
  int height = 0;                         ///< [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  std::array<double, 4> k{};              ///< k1 k2 k3 k4 [-]

  /// The pixel of the ray (x, y, 1).
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector2d& ray) const;
};

/// A pinhole camera with radial distortion in place of a fisheye camera.
struct FisheyeFit {
  PinholeCamera camera;
  double residual_px = 0;  ///< the most that a pixel of the sensor is off
};

/// The least-squares fit of s r (1 + k1 r^2 + k2 r^4 + k3 r^6) to d over the sensor, each ring
/// weighted by its area; s scales both focal lengths. Throws InputError(place) where the lens sees
/// 80 degrees off its axis or more, which no pinhole camera stands for.
[[nodiscard]] FisheyeFit fit_pinhole(const FisheyeCamera& camera, const std::string& place);

}  // namespace saccade
