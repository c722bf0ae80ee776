#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "estimator/refinement/jacobian_block.h"

namespace saccade {

/// Unknowns held at their means: (x_k - mean_k) / sigma_k; a sigma of infinity holds nothing.
template <int kSize>
class HeldCost : public ceres::SizedCostFunction<kSize, kSize> {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;
  HeldCost(const Vector& mean, const Vector& sigma)
      : mean_(mean), precision_(sigma.cwiseInverse()) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector> x(parameters[0]);
    Eigen::Map<Vector>(residuals, kSize) = precision_.cwiseProduct(x - mean_);
    if (jacobians != nullptr)
      write_block(jacobians[0], Eigen::Matrix<double, kSize, kSize>(precision_.asDiagonal()));
    return true;
  }

 private:
  Vector mean_, precision_;
};

}  // namespace saccade
