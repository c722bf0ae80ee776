#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace saccade {

/// Pinhole camera with radial-tangential distortion (Brown; OpenCV's k1 k2 p1 p2 k3).
/// Pixel centres lie at integer coordinates: pixel (0, 0) covers [-0.5, 0.5]^2. Looks along +z.
struct PinholeCamera {
  int width = 0;                          ///< [px]
  int height = 0;                         ///< [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
  std::array<double, 5> distortion{};     ///< k1 k2 p1 p2 k3 [-]

  [[nodiscard]] bool operator==(const PinholeCamera&) const = default;

  [[nodiscard]] bool is_distorted() const { return distortion != std::array<double, 5>{}; }

  /// K: pi without distortion as a matrix, on homogeneous coordinates.
  [[nodiscard]] Eigen::Matrix3d matrix() const;

  /// pi (thesis 4.9) without distortion; `point` in the camera frame [m], z != 0.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }

  /// The ray (x, y, 1) through an undistorted pixel; times depth it is pi^-1 (thesis 4.10).
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1};
  }

  /// d project / d point (2x3).
  [[nodiscard]] Eigen::Matrix<double, 2, 3> project_jacobian(const Eigen::Vector3d& point) const;

  /// Undistorted pixel -> the pixel where the lens puts it.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& pixel) const;

  /// Inverse of distort(), by Newton iterations to 1e-9 px. Where the model folds over (far outside
  /// the image) the closest point that the iterations reach is returned.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;

  /// The same camera without lens distortion.
  [[nodiscard]] PinholeCamera undistorted() const;

  [[nodiscard]] bool contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= width - 1 && pixel.y() <= height - 1;
  }

  /// Throws InputError(location) unless sizes and focal lengths are positive and all numbers
  /// finite.
  void check(const std::string& location) const;
};

/// d pi(exp(xi^) p) / d xi at xi = 0 (2x6) [px]: the interaction matrix for the POINT's motion,
/// that is minus the printed (4.17), times the focal lengths. `ray` = (x, y, 1), `depth` > 0 [m].
[[nodiscard]] Eigen::Matrix<double, 2, 6> interaction_matrix(const PinholeCamera& camera,
                                                             const Eigen::Vector3d& ray,
                                                             double depth);

/// Undistorted position of every sensor pixel, row-major [px]; computed once, read once per event.
class UndistortionTable {
 public:
  explicit UndistortionTable(const PinholeCamera& camera);

  [[nodiscard]] const Eigen::Vector2f& operator()(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }

 private:
  int width_;
  std::vector<Eigen::Vector2f> pixels_;
};

}  // namespace saccade
