#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>

namespace saccade::testing {

/// Central differences of a function of `Columns` parameters with `Rows` values, at `x`.
template <int Rows, int Columns, class Function>
Eigen::Matrix<double, Rows, Columns> central_differences(const Function& function,
                                                         const Eigen::Matrix<double, Columns, 1>& x,
                                                         double step) {
  Eigen::Matrix<double, Rows, Columns> jacobian;
  for (int c = 0; c < Columns; ++c) {
    Eigen::Matrix<double, Columns, 1> forward = x;
    Eigen::Matrix<double, Columns, 1> backward = x;
    forward[c] += step;
    backward[c] -= step;
    jacobian.col(c) = (function(forward) - function(backward)) / (2 * step);
  }
  return jacobian;
}

/// Expects that `jacobian` is the derivative of `function` at `x`, to `tolerance` relative to its
/// largest entry (at least 1). The step suits smooth functions of values around 1: its error is
/// about 1e-10.
template <int Rows, int Columns, class Function>
void expect_jacobian(const Eigen::Matrix<double, Rows, Columns>& jacobian, const Function& function,
                     const Eigen::Matrix<double, Columns, 1>& x, double tolerance = 1e-7,
                     double step = 1e-5) {
  const Eigen::Matrix<double, Rows, Columns> numeric =
      central_differences<Rows, Columns>(function, x, step);
  const double scale = std::max(1.0, numeric.cwiseAbs().maxCoeff());
  EXPECT_LT((jacobian - numeric).cwiseAbs().maxCoeff(), tolerance * scale)
      << "analytic\n"
      << jacobian << "\nnumeric\n"
      << numeric << "\nat " << x.transpose();
}

}  // namespace saccade::testing
