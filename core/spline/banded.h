#pragma once

#include <optional>

#include <Eigen/Core>

namespace saccade {

/// Linear least squares min sum |J x - r|^2 whose rows each touch a few neighbouring unknowns:
/// normal equations in band storage, solved by Cholesky in O(unknowns * reach^2).
class BandedLeastSquares {
 public:
  /// `reach`: no row touches unknowns further than this apart. `right_sides`: columns of r and x.
  BandedLeastSquares(Eigen::Index unknowns, Eigen::Index reach, Eigen::Index right_sides);

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
  [[nodiscard]] std::optional<Eigen::MatrixXd> solve();

 private:
  [[nodiscard]] bool factorize();

  Eigen::MatrixXd band_;   ///< (reach + 1) x unknowns: (k, i) is the entry (i + k, i)
  Eigen::MatrixXd right_;  ///< unknowns x right_sides
};

}  // namespace saccade
