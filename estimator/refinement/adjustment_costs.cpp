#include "estimator/refinement/adjustment_costs.h"

#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

namespace saccade {
namespace {

/// A derivative as Ceres wants it, by rows.
template <int kRows, int kColumns>
void write(double* target, const Eigen::Matrix<double, kRows, kColumns>& derivative) {
  Eigen::Map<Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>> map(target);
  map = derivative;
}

}  // namespace

Matrix6 image_motion_root(const PinholeCamera& camera, double depth_m, double sigma_px) {
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

SoftResidual soft(double residual, double scale) {
  const double squared = (residual / scale) * (residual / scale);
  // The series of sqrt(log1p(x) / x), where the quotient has no digits left.
  const double shrunk = squared < 1e-8 ? 1 - squared / 4 : std::sqrt(std::log1p(squared) / squared);
  return {residual * shrunk, 1 / (shrunk * (1 + squared))};
}

bool EventPairCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const Eigen::Map<const Twist> before(parameters[0]), after(parameters[1]);
  const Eigen::Map<const EdgeUnknowns> edge(parameters[2]);
  for (std::size_t row = 0; row < 2; ++row) {
    const auto& [observation, share, weight] = events_[row];
    EdgeDerivatives derivatives;
    const double residual =
        edge_residual(observation, camera_, (1 - share) * before + share * after, edge,
                      jacobians != nullptr ? &derivatives : nullptr);
    if (!std::isfinite(residual)) return false;
    const auto [value, slope] = soft(weight * residual, outlier_);
    residuals[row] = value;
    if (jacobians == nullptr) continue;
    const double scale = weight * slope;
    if (jacobians[0] != nullptr)
      write<1, 6>(jacobians[0] + row * 6, scale * (1 - share) * derivatives.motion);
    if (jacobians[1] != nullptr)
      write<1, 6>(jacobians[1] + row * 6, scale * share * derivatives.motion);
    if (jacobians[2] != nullptr) write<1, 4>(jacobians[2] + row * 4, scale * derivatives.edge);
  }
  return true;
}

bool EdgePriorCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const Eigen::Map<const Eigen::Vector2d> x(parameters[0] + first_);
  Eigen::Map<Eigen::Vector2d>(residuals, 2) = precision_.cwiseProduct(x - mean_);
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Matrix<double, 2, 4> derivative = Eigen::Matrix<double, 2, 4>::Zero();
  derivative.middleCols<2>(first_) = precision_.asDiagonal();
  write<2, 4>(jacobians[0], derivative);
  return true;
}

bool NodePriorCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  Eigen::Map<Twist>(residuals, NodeCorrection::kSize) =
      root_ * Eigen::Map<const Twist>(parameters[0]);
  if (jacobians != nullptr && jacobians[0] != nullptr) write<6, 6>(jacobians[0], root_);
  return true;
}

bool NodeStepCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const Eigen::Map<const Twist> before(parameters[0]), after(parameters[1]);
  Eigen::Map<Twist>(residuals, NodeCorrection::kSize) = root_ * (after - before);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) write<6, 6>(jacobians[0], Matrix6(-root_));
  if (jacobians[1] != nullptr) write<6, 6>(jacobians[1], root_);
  return true;
}

}  // namespace saccade
