#pragma once

#include <Eigen/Core>
#include <cmath>

namespace saccade {

/// A = L L^T of a small symmetric positive definite matrix. Written out because the loops unroll
/// for a fixed N, several times faster than a general decomposition of this size.
template <int N>
class Cholesky {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// Reads the upper triangle of `a`. False when a pivot falls below 1e-12 of its diagonal element:
  /// the unknown is then determined by the others as far as the data say.
  [[nodiscard]] bool factor(const Matrix& a) {
    for (int j = 0; j < N; ++j) {
      double pivot = a(j, j);
      for (int k = 0; k < j; ++k) pivot -= l_(j, k) * l_(j, k);
      if (!(pivot > 1e-12 * a(j, j)) || !std::isfinite(pivot)) return false;
      const double inverse = 1 / std::sqrt(pivot);
      l_(j, j) = inverse;
      for (int i = j + 1; i < N; ++i) {
        double sum = a(j, i);
        for (int k = 0; k < j; ++k) sum -= l_(i, k) * l_(j, k);
        l_(i, j) = sum * inverse;
      }
    }
    return true;
  }

  [[nodiscard]] Vector solve(Vector b) const {
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < i; ++k) b(i) -= l_(i, k) * b(k);
      b(i) *= l_(i, i);
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int k = i + 1; k < N; ++k) b(i) -= l_(k, i) * b(k);
      b(i) *= l_(i, i);
    }
    return b;
  }

 private:
  Matrix l_ = Matrix::Zero();  ///< lower triangle; the diagonal holds the inverse pivots
};

/// Inverse of a symmetric positive definite matrix; zero when it is not.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, N> inverse_symmetric(const Eigen::Matrix<double, N, N>& a) {
  Eigen::Matrix<double, N, N> inverse = Eigen::Matrix<double, N, N>::Zero();
  Cholesky<N> factors;
  if (!factors.factor(a)) return inverse;
  for (int i = 0; i < N; ++i) inverse.col(i) = factors.solve(Eigen::Matrix<double, N, 1>::Unit(i));
  return inverse;
}

}  // namespace saccade
