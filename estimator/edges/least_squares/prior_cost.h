#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <initializer_list>
#include <utility>
#include <vector>

#include "estimator/edges/least_squares/jacobian_block.h"

namespace saccade {

/// A Gaussian prior on a linear function of unknowns x_1 .. x_n, blocks of kSize numbers each:
///   r = W (sum_k weight_k x_k - mean),   W^T W the information
/// (Barfoot, State Estimation for Robotics, 2017, section 3.1). The one prior of all paths and edges: a
/// single block is held at its mean, weights -1 and 1 make a random walk between neighbours, those
/// of a spline a measurement of its value. A column of W that is 0 constrains nothing. `kRows` is
/// kSize unless Ceres shall use a Schur eliminator that is compiled for fewer.
template <int kSize, int kRows = kSize>
class LinearPriorCost : public ceres::CostFunction {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Root = Eigen::Matrix<double, kRows, kSize>;

  /// `root`: W.
  LinearPriorCost(const Root& root, const Vector& mean, std::vector<double> weights = {1})
      : root_(root), mean_(mean), weights_(std::move(weights)) {
    set_num_residuals(kRows);
    mutable_parameter_block_sizes()->assign(weights_.size(), kSize);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < weights_.size(); ++k)
      sum += weights_[k] * Eigen::Map<const Vector>(parameters[k]);
    Eigen::Map<Eigen::Matrix<double, kRows, 1>>(residuals, kRows) = root_ * (sum - mean_);
    if (jacobians == nullptr) return true;
    for (std::size_t k = 0; k < weights_.size(); ++k)
      write_block(jacobians[k], Root(weights_[k] * root_));
    return true;
  }

 private:
  Root root_;
  Vector mean_;
  std::vector<double> weights_;
};

/// The root of the information of independent unknowns with these standard deviations; one of
/// infinity constrains nothing.
template <int kSize>
[[nodiscard]] Eigen::Matrix<double, kSize, kSize> root_of_sigma(
    const Eigen::Matrix<double, kSize, 1>& sigma) {
  return sigma.cwiseInverse().asDiagonal();
}

}  // namespace saccade
