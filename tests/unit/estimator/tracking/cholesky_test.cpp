#include "estimator/tracking/cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "core/random.h"

namespace saccade {
namespace {

using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Vector8 = Eigen::Matrix<double, 8, 1>;

Matrix8 random_matrix(std::uint64_t index) {
  const Random random(3);
  Matrix8 a;
  for (int i = 0; i < a.size(); ++i) a(i) = random.normal(index, static_cast<std::uint64_t>(i));
  return a;
}

TEST(Cholesky, SolvesLikeEigen) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Matrix8 root = random_matrix(i);
    const Matrix8 a = root * root.transpose() + 0.01 * Matrix8::Identity();
    const Vector8 b = random_matrix(i + 100).col(0);
    Cholesky<8> factors;
    ASSERT_TRUE(factors.factor(a));
    const Vector8 expected = a.ldlt().solve(b);
    EXPECT_LT((factors.solve(b) - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(Cholesky, ReadsTheUpperTriangleAlone) {
  const Matrix8 root = random_matrix(1);
  const Matrix8 a = root * root.transpose() + Matrix8::Identity();
  Matrix8 upper = a;
  upper.triangularView<Eigen::StrictlyLower>().setConstant(
      std::numeric_limits<double>::quiet_NaN());
  Cholesky<8> whole, half;
  ASSERT_TRUE(whole.factor(a));
  ASSERT_TRUE(half.factor(upper));
  EXPECT_EQ(whole.solve(Vector8::Ones()), half.solve(Vector8::Ones()));
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
  Cholesky<8> factors;
  EXPECT_FALSE(factors.factor(Matrix8::Zero()));
  EXPECT_FALSE(factors.factor(-Matrix8::Identity()));
  Matrix8 unseen = Matrix8::Identity();
  unseen(3, 3) = 0;
  EXPECT_FALSE(factors.factor(unseen));
  EXPECT_FALSE(factors.factor(Matrix8::Ones())) << "rank one";
  EXPECT_FALSE(factors.factor(Matrix8::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Cholesky, ScaleOfAnUnknownDoesNotMatter) {
  // Metres and radians differ by orders of magnitude; a pivot is judged against its own diagonal.
  const Matrix8 root = random_matrix(2);
  Vector8 units;
  units << 1e-6, 1e6, 1, 1e3, 1e-3, 1e5, 1e-5, 1;
  const Matrix8 a =
      units.asDiagonal() * (root * root.transpose() + Matrix8::Identity()) * units.asDiagonal();
  Cholesky<8> factors;
  EXPECT_TRUE(factors.factor(a));
}

TEST(Cholesky, InverseOfASymmetricMatrix) {
  const Matrix8 root = random_matrix(4);
  const Matrix8 a = root * root.transpose() + Matrix8::Identity();
  EXPECT_TRUE((a * inverse_symmetric<8>(a)).isIdentity(1e-10));
  EXPECT_EQ(inverse_symmetric<8>(Matrix8::Zero()), Matrix8::Zero());
}

}  // namespace
}  // namespace saccade
