#include "estimator/edges/least_squares/small_cholesky.h"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

TEST(SmallCholesky, SolvesAndLeavesHalfAProduct) {
  Eigen::Matrix<double, 5, 5> root;
  for (int i = 0; i < 25; ++i) root.data()[i] = std::sin(1.7 * i) + (i % 6 == 0 ? 2 : 0);
  const Eigen::Matrix<double, 5, 5> matrix = root * root.transpose();
  SmallCholesky<5> cholesky;
  cholesky.compute(matrix);
  const Eigen::Matrix<double, 5, 1> right(1, -2, 3, 0.5, 4);
  EXPECT_LT((matrix * cholesky.solve(right) - right).norm(), 1e-12);
  Eigen::Matrix<double, 5, 3, Eigen::RowMajor> rows;
  for (int i = 0; i < 15; ++i) rows.data()[i] = std::cos(0.9 * i);
  const Eigen::Matrix3d product = rows.transpose() * matrix.inverse() * rows;
  cholesky.solve_lower(rows.data(), 3);
  EXPECT_LT((rows.transpose() * rows - product).norm(), 1e-12 * product.norm());
}

TEST(SmallCholesky, OfAnIndefiniteMatrixIsNotANumber) {
  SmallCholesky<2> cholesky;
  cholesky.compute(Eigen::Vector2d(1, -1).asDiagonal());
  EXPECT_TRUE(cholesky.solve({1, 1}).hasNaN());
}

}  // namespace
}  // namespace saccade
