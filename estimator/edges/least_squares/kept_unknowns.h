#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "estimator/edges/least_squares/reduced_system.h"

namespace saccade {

/// A residual of kept unknowns alone, without a loss.
struct KeptFactor {
  std::unique_ptr<ceres::CostFunction> cost;
  std::vector<double*> blocks;
};

/// The unknowns of a bundle that are not eliminated, as one vector: those of the path, a block of six
/// for each twist, then the others, a block for each array; and the factors that depend on them alone.
class KeptUnknowns {
 public:
  struct Place {
    std::uint32_t block = 0;
    std::size_t index = 0;  ///< in the vector
  };

  /// `kept`: the path first. Arrays and factors outlive this.
  KeptUnknowns(std::span<const std::span<double>> kept, std::span<const KeptFactor> factors);

  /// Twists of the path; they are the first blocks.
  [[nodiscard]] std::size_t path_blocks() const { return path_blocks_; }
  /// Where each block begins, and behind them the number of unknowns.
  [[nodiscard]] const std::vector<Eigen::Index>& begin() const { return begin_; }
  [[nodiscard]] Eigen::Index size(std::uint32_t block) const {
    return begin_[block + 1] - begin_[block];
  }
  /// Of an unknown by its address with the caller.
  [[nodiscard]] Place place(const double* unknown) const;

  /// As they are with the caller.
  [[nodiscard]] std::vector<double> values() const;
  void write(std::span<const double> values);

  /// The blocks of each factor, ascending.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> factor_blocks() const;
  /// Half the sum of squares; infinite where a factor cannot be evaluated.
  [[nodiscard]] double cost(std::span<const double> values) const;
  void linearise(std::span<const double> values);
  /// Adds the factors' J^T J to the system, its diagonal to `diagonal` and J^T r to `gradient` and `right`.
  void add_to(ReducedSystem& system, Eigen::VectorXd& gradient, Eigen::VectorXd& right,
              Eigen::VectorXd& diagonal) const;

 private:
  struct Array {
    std::span<double> values;
    std::size_t index;
    std::uint32_t block;
    std::size_t block_size;
  };
  struct Linear {
    std::vector<std::uint32_t> blocks;
    Eigen::MatrixXd square;
    Eigen::VectorXd gradient;
  };
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] Linear linear(const KeptFactor& factor, std::span<const double> values) const;

  std::vector<Array> arrays_;  ///< in order of their addresses
  std::span<const KeptFactor> factors_;
  std::size_t path_blocks_;
  std::vector<Eigen::Index> begin_{0};
  std::vector<Linear> linear_;
};

}  // namespace saccade
