#include "estimator/edges/least_squares/marginal_information.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstddef>

namespace saccade {
namespace {

/// The rows of one eliminated block, over those of the kept columns that they touch.
class Rows {
 public:
  Rows(const ceres::CRSMatrix& jacobian, const std::vector<int>& rows, int kept, int block_size)
      : jacobian_(jacobian), rows_(rows), kept_(kept), block_size_(block_size) {
    for_each([&](Eigen::Index, int column, double) {
      if (column < kept_) columns_.push_back(column);
    });
    std::sort(columns_.begin(), columns_.end());
    columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  }

  void add_to(Eigen::MatrixXd& information) const {
    const auto count = static_cast<Eigen::Index>(rows_.size());
    const auto touched = static_cast<Eigen::Index>(columns_.size());
    Eigen::MatrixXd by_kept = Eigen::MatrixXd::Zero(count, touched);
    Eigen::MatrixXd by_block = Eigen::MatrixXd::Zero(count, block_size_);
    for_each([&](Eigen::Index row, int column, double value) {
      if (column < kept_)
        by_kept(row, std::lower_bound(columns_.begin(), columns_.end(), column) -
                         columns_.begin()) = value;
      else
        by_block(row, (column - kept_) % block_size_) = value;
    });
    Eigen::MatrixXd part = by_kept.transpose() * by_kept;
    const Eigen::LLT<Eigen::MatrixXd> of_block(by_block.transpose() * by_block);
    if (of_block.info() == Eigen::Success) {
      const Eigen::MatrixXd cross = by_block.transpose() * by_kept;
      part -= cross.transpose() * of_block.solve(cross);
    }
    for (Eigen::Index i = 0; i < touched; ++i)
      for (Eigen::Index j = 0; j < touched; ++j)
        information(columns_[static_cast<std::size_t>(i)], columns_[static_cast<std::size_t>(j)]) +=
            part(i, j);
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const auto row = static_cast<std::size_t>(rows_[r]);
      for (int k = jacobian_.rows[row]; k < jacobian_.rows[row + 1]; ++k)
        visit(static_cast<Eigen::Index>(r), jacobian_.cols[static_cast<std::size_t>(k)],
              jacobian_.values[static_cast<std::size_t>(k)]);
    }
  }

  const ceres::CRSMatrix& jacobian_;
  const std::vector<int>& rows_;
  int kept_, block_size_;
  std::vector<int> columns_;
};

}  // namespace

Eigen::MatrixXd marginal_information(ceres::Problem& problem, const std::vector<double*>& kept,
                                     const std::vector<double*>& eliminated) {
  int kept_size = 0;
  for (const double* block : kept) kept_size += problem.ParameterBlockSize(block);
  const int block_size = eliminated.empty() ? 1 : problem.ParameterBlockSize(eliminated.front());
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = kept;
  options.parameter_blocks.insert(options.parameter_blocks.end(), eliminated.begin(),
                                  eliminated.end());
  ceres::CRSMatrix jacobian;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) return {};
  // A row of kept blocks alone is a group of its own, after those of the eliminated ones.
  std::vector<std::vector<int>> groups(eliminated.size());
  for (int row = 0; row < jacobian.num_rows; ++row) {
    std::size_t group = groups.size();
    for (int k = jacobian.rows[static_cast<std::size_t>(row)];
         k < jacobian.rows[static_cast<std::size_t>(row) + 1]; ++k)
      if (const int column = jacobian.cols[static_cast<std::size_t>(k)]; column >= kept_size)
        group = static_cast<std::size_t>((column - kept_size) / block_size);
    if (group == groups.size()) groups.emplace_back();
    groups[group].push_back(row);
  }
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kept_size, kept_size);
  for (const std::vector<int>& rows : groups)
    if (!rows.empty()) Rows(jacobian, rows, kept_size, block_size).add_to(information);
  return information;
}

}  // namespace saccade
