#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace saccade {

/// The normal equations of the unknowns that a Schur complement keeps: symmetric, of blocks, of
/// which some couple. Solved by Cholesky: dense where the blocks are few or most of them couple,
/// else sparse with a fill-reducing order, so that time and memory grow with the couplings.
class ReducedSystem {
 public:
  /// Block i has the unknowns begin[i] .. begin[i + 1] - 1. Each group's blocks, in ascending order, couple with one another.
  ReducedSystem(std::vector<Eigen::Index> begin,
                std::span<const std::vector<std::uint32_t>> groups);

  [[nodiscard]] Eigen::Index size() const { return begin_.back(); }
  [[nodiscard]] bool is_dense() const { return is_dense_; }

  void set_zero();
  /// Adds a matrix over the unknowns of a group's blocks; its lower triangle counts.
  void add(std::span<const std::uint32_t> blocks, const Eigen::MatrixXd& lower);
  void add_diagonal(const Eigen::VectorXd& diagonal);

  /// The whole matrix.
  [[nodiscard]] Eigen::MatrixXd matrix() const;

  /// False where the matrix is not positive definite.
  [[nodiscard]] bool factorise();
  /// After factorise().
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  /// Blocks first .. first + count - 1 of the inverse's diagonal for each `first` in turn, `groups`
  /// of them: the blocks of each must couple. After factorise(). Of a sparse system by the
  /// recursion of Takahashi et al. (1973), which computes the inverse where the factor is not zero.
  [[nodiscard]] std::vector<Eigen::MatrixXd> inverse_blocks(std::size_t count,
                                                            std::size_t groups) const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;

  void make_pattern(std::span<const std::vector<std::uint32_t>> coupled);
  [[nodiscard]] Sparse inverse_on_factor() const;

  std::vector<Eigen::Index> begin_;
  bool is_dense_ = true;
  Eigen::MatrixXd dense_;
  Eigen::LLT<Eigen::MatrixXd> dense_factor_;
  Sparse sparse_;  ///< lower triangle
  Eigen::SimplicialLLT<Sparse, Eigen::Lower> sparse_factor_;
};

}  // namespace saccade
