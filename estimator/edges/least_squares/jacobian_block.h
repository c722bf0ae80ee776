#pragma once

#include <Eigen/Core>

namespace saccade {

/// A derivative by a block of unknowns, in rows as Ceres wants it. `target` null: not asked for.
template <class Derived>
void write_block(double* target, const Eigen::MatrixBase<Derived>& derivative) {
  constexpr int kRows = Derived::RowsAtCompileTime, kColumns = Derived::ColsAtCompileTime;
  constexpr int kOrder = kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor;
  if (target == nullptr) return;
  Eigen::Map<Eigen::Matrix<double, kRows, kColumns, kOrder>> block(target);
  block = derivative;
}

}  // namespace saccade
