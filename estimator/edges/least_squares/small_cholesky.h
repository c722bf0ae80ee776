#pragma once

#include <cmath>

#include <Eigen/Core>

namespace saccade {

/// Cholesky's factor L of a small symmetric matrix, as loops of one form. Eigen's own, of a matrix
/// in a larger object, rounds differently where the matrix lies at another address, and the sums of
/// a bundle must not hang on that.
template <int kSize>
class SmallCholesky {
 public:
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  /// Of the lower triangle. Not a number where the matrix is not positive definite.
  void compute(const Matrix& matrix) {
    for (int j = 0; j < kSize; ++j)
      for (int i = j; i < kSize; ++i) {
        double sum = matrix(i, j);
        for (int k = 0; k < j; ++k) sum -= l_(i, k) * l_(j, k);
        l_(i, j) = i == j ? std::sqrt(sum) : sum / l_(j, j);
      }
  }

  /// L^-1 Y, of kSize rows of `count` numbers one after the other.
  void solve_lower(double* rows, Eigen::Index count) const {
    for (int j = 0; j < kSize; ++j) {
      double* row = rows + j * count;
      for (int k = 0; k < j; ++k) {
        const double* before = rows + k * count;
        for (Eigen::Index i = 0; i < count; ++i) row[i] -= l_(j, k) * before[i];
      }
      for (Eigen::Index i = 0; i < count; ++i) row[i] /= l_(j, j);
    }
  }

  /// (L L^T)^-1 y.
  [[nodiscard]] Vector solve(Vector y) const {
    solve_lower(y.data(), 1);
    for (int j = kSize; j-- > 0;) {
      for (int k = j + 1; k < kSize; ++k) y[j] -= l_(k, j) * y[k];
      y[j] /= l_(j, j);
    }
    return y;
  }

 private:
  Matrix l_ = Matrix::Zero();
};

}  // namespace saccade
