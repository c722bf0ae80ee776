#include "core/spline/banded.h"

#include <algorithm>
#include <cmath>

namespace saccade {

BandedLeastSquares::BandedLeastSquares(Eigen::Index unknowns, Eigen::Index reach,
                                       Eigen::Index right_sides)
    : band_(Eigen::MatrixXd::Zero(reach + 1, unknowns)),
      right_(Eigen::MatrixXd::Zero(unknowns, right_sides)) {}

bool BandedLeastSquares::factorize() {
  const Eigen::Index n = band_.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(band_(0, i) > 0)) return false;
    const Eigen::Index below = std::min(band_.rows() - 1, n - 1 - i);
    band_.col(i).head(below + 1) /= std::sqrt(band_(0, i));
    for (Eigen::Index k = 1; k <= below; ++k) {
      band_.col(i + k).head(below + 1 - k) -= band_(k, i) * band_.col(i).segment(k, below + 1 - k);
    }
  }
  return true;
}

std::optional<Eigen::MatrixXd> BandedLeastSquares::solve() {
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

}  // namespace saccade
