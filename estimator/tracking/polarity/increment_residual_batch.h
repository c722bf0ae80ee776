#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/rigid3.h"
#include "estimator/lanes.h"
#include "estimator/tracking/polarity/increment_template.h"
#include "estimator/tracking/pose_solver.h"

namespace saccade {

/// Up to kCapacity neighbouring points of an increment template in an iteration of the
/// alignment, in single precision, so that all of it is vector code.
class IncrementResidualBatch {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// sigma of a pixel's sum of polarities [thresholds], and of its reprojection, as the map
  /// consists of point samples.
  static constexpr float kSigma = 0.2F;
  static constexpr float kPositionSigma_px = 0.2F;

  /// Residuals of the points from `first` on,
  ///   r = E(W(u; current_from_template)) - k M(u),
  /// with weights (n / sigma)^2 / (1 + (r / (2.4 sigma))^2) (Cauchy), 0 outside of the frame, where
  ///   sigma^2 = n^2 + (s k |grad M|)^2,
  /// n = `sigma` and s = `position_sigma_px`. `gain`: k [thresholds / (log unit/s)].
  void evaluate(const PinholeCamera& camera, const ImageF& frame, const IncrementPoints& points,
                std::size_t first, const Rigid3& current_from_template, double gain,
                float sigma = kSigma, float position_sigma_px = kPositionSigma_px);

  /// Sums over points; J holds the seven derivatives of k M by the points' motion xi and by k.
  struct Sums {
    Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();  ///< J^T W J, upper
    Eigen::Matrix<double, 7, 1> rhs = Eigen::Matrix<double, 7, 1>::Zero();     ///< J^T W r
    double weight = 0;    ///< 1 / (1 + (r / (2.4 sigma))^2)
    double squares = 0;   ///< r^2 by this weight
    double visible = 0;   ///< points inside of the frame
    double product = 0;   ///< E M
    double absolute = 0;  ///< |E M|
    double expected = 0;  ///< M^2

    /// For xi alone, k being whatever fits best.
    [[nodiscard]] PoseEquations of_pose() const;
    /// Fraction of the products E M that are positive, by size: 0.5 is chance.
    [[nodiscard]] double agreement() const {
      return absolute > 0 ? 0.5 * (1 + product / absolute) : 0;
    }
  };
  /// Of the points that were evaluated last.
  void add_to(Sums& sums);

 private:
  using Floats = std::array<float, kCapacity>;
  void warp(const PinholeCamera& camera, const ImageF& frame, const IncrementPoints& points,
            std::size_t first, const Rigid3& current_from_template);
  void read(const ImageF& frame);

  std::size_t count_ = 0;   ///< of the points
  std::size_t padded_ = 0;  ///< the same, rounded up to lanes
  std::array<const float*, 7> columns_{};
  alignas(64) Floats at_x_{}, at_y_{}, visible_{}, value_{};
  alignas(64) Floats residual_{}, relative_{}, weight_{}, weighted_{};
  alignas(64) std::array<std::int32_t, kCapacity> cell_{};
  double gain_ = 0;
};

}  // namespace saccade
