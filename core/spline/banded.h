#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Core>

namespace saccade {

/// Linear least squares min sum |J x - r|^2 whose rows each touch a few neighbouring unknowns:
/// normal equations in band storage, solved by Cholesky in O(unknowns * reach^2).
class BandedLeastSquares {
 public:
  /// `reach`: no row touches unknowns further than this apart. `right_sides`: columns of r and x.
  BandedLeastSquares(Eigen::Index unknowns, Eigen::Index reach, Eigen::Index right_sides)
      : band_(Eigen::MatrixXd::Zero(reach + 1, unknowns)),
        right_(Eigen::MatrixXd::Zero(unknowns, right_sides)) {}

  /// Adds rows over the unknowns first .. first + jacobian.cols() - 1; `residual`: rows x
  /// right_sides.
  template <class Jacobian, class Residual>
  void add(Eigen::Index first, const Eigen::MatrixBase<Jacobian>& jacobian,
           const Eigen::MatrixBase<Residual>& residual) {
    for (Eigen::Index c = 0; c < jacobian.cols(); ++c) {
      for (Eigen::Index d = c; d < jacobian.cols(); ++d) {
        band_(d - c, first + c) += jacobian.col(c).dot(jacobian.col(d));
      }
      for (Eigen::Index s = 0; s < right_.cols(); ++s) {
        right_(first + c, s) += jacobian.col(c).dot(residual.col(s));
      }
    }
  }

  /// The solution, unknowns x right_sides; nullopt when the rows do not determine it. Call once.
  [[nodiscard]] std::optional<Eigen::MatrixXd> solve() {
    if (!factorize()) return std::nullopt;
    const Eigen::Index n = band_.cols();
    Eigen::MatrixXd x = std::move(right_);
    for (Eigen::Index i = 0; i < n; ++i) {
      x.row(i) /= band_(0, i);
      const Eigen::Index below = std::min(band_.rows() - 1, n - 1 - i);
      for (Eigen::Index k = 1; k <= below; ++k) x.row(i + k) -= band_(k, i) * x.row(i);
    }
    for (Eigen::Index i = n - 1; i >= 0; --i) {
      const Eigen::Index below = std::min(band_.rows() - 1, n - 1 - i);
      for (Eigen::Index k = 1; k <= below; ++k) x.row(i) -= band_(k, i) * x.row(i + k);
      x.row(i) /= band_(0, i);
    }
    return x;
  }

 private:
  [[nodiscard]] bool factorize() {
    const Eigen::Index n = band_.cols();
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!(band_(0, i) > 0)) return false;
      const Eigen::Index below = std::min(band_.rows() - 1, n - 1 - i);
      band_.col(i).head(below + 1) /= std::sqrt(band_(0, i));
      for (Eigen::Index k = 1; k <= below; ++k) {
        band_.col(i + k).head(below + 1 - k) -=
            band_(k, i) * band_.col(i).segment(k, below + 1 - k);
      }
    }
    return true;
  }

  Eigen::MatrixXd band_;   ///< (reach + 1) x unknowns: (k, i) is the entry (i + k, i)
  Eigen::MatrixXd right_;  ///< unknowns x right_sides
};

}  // namespace saccade
