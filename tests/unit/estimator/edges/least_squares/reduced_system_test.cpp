#include "estimator/edges/least_squares/reduced_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace saccade {
namespace {

using Groups = std::vector<std::vector<std::uint32_t>>;

/// Blocks of six and, last, one of five.
std::vector<Eigen::Index> begins(std::size_t blocks) {
  std::vector<Eigen::Index> begin;
  for (std::size_t i = 0; i < blocks; ++i) begin.push_back(static_cast<Eigen::Index>(6 * i));
  begin.push_back(begin.back() + 5);
  return begin;
}

/// Neighbours along a path, some far ones, and the last block with a few.
Groups path_groups(std::uint32_t blocks) {
  Groups groups;
  for (std::uint32_t i = 0; i + 4 < blocks; ++i) {
    groups.emplace_back(4);
    std::iota(groups.back().begin(), groups.back().end(), i);
  }
  groups.push_back({3, 4, blocks / 2, blocks - 2});
  groups.push_back({blocks - 3, blocks - 2, blocks - 1});
  return groups;
}

/// Adds a product of random rows for each group, to the system and to a dense matrix.
Eigen::MatrixXd fill(ReducedSystem& system, const std::vector<Eigen::Index>& begin,
                     const Groups& groups) {
  const Random random(11);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(system.size(), system.size());
  system.set_zero();
  std::uint64_t draw = 0;
  for (const auto& group : groups) {
    std::vector<Eigen::Index> unknowns;
    for (const std::uint32_t block : group)
      for (Eigen::Index i = begin[block]; i < begin[block + 1]; ++i) unknowns.push_back(i);
    const auto size = static_cast<Eigen::Index>(unknowns.size());
    Eigen::MatrixXd rows(size, size);
    for (double& value : rows.reshaped()) value = random.uniform(draw++, 0) - 0.5;
    const Eigen::MatrixXd square = rows.transpose() * rows;
    Eigen::MatrixXd lower = square.triangularView<Eigen::Lower>();
    system.add(group, lower);
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j)
        dense(unknowns[static_cast<std::size_t>(i)], unknowns[static_cast<std::size_t>(j)]) +=
            square(i, j);
  }
  const Eigen::VectorXd diagonal = Eigen::VectorXd::LinSpaced(system.size(), 0.5, 1.5);
  system.add_diagonal(diagonal);
  dense.diagonal() += diagonal;
  return dense;
}

class ReducedSystems : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(ReducedSystems, SolveAndInvertAsADenseMatrixDoes) {
  const std::uint32_t blocks = GetParam();
  const std::vector<Eigen::Index> begin = begins(blocks);
  const Groups groups = path_groups(blocks);
  ReducedSystem system(begin, groups);
  EXPECT_EQ(system.is_dense(), blocks < 200);
  const Eigen::MatrixXd dense = fill(system, begin, groups);
  ASSERT_TRUE(system.factorise());
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(system.size(), -1, 2);
  EXPECT_LT((dense * system.solve(right) - right).norm(), 1e-9 * right.norm());
  const Eigen::MatrixXd inverse = dense.inverse();
  const auto found = system.inverse_blocks(4, blocks - 5);
  ASSERT_EQ(found.size(), blocks - 5);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto expected = inverse.block(begin[i], begin[i], 24, 24);
    EXPECT_LT((found[i] - expected).norm(), 1e-9 * expected.norm()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(DenseAndSparse, ReducedSystems, ::testing::Values(20U, 300U));

TEST(ReducedSystem, WithoutInformationItIsNotFactorised) {
  const std::vector<Eigen::Index> begin = begins(6);
  ReducedSystem system(begin, path_groups(6));
  system.set_zero();
  EXPECT_FALSE(system.factorise());
}

}  // namespace
}  // namespace saccade
