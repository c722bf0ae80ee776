#include <gtest/gtest.h>
#include <Eigen/QR>

#include "core/banded.h"
#include "core/rigid3.h"
#include "core/spline_rotation.h"

namespace saccade {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep = 1e-5;

/// Central difference of Log(f(0)^-1 f(d)) by d.
template <class Function>
Vector3d difference(const Function& f) {
  const Quaterniond at = f(0.0);
  return (so3_log(at.conjugate() * f(kStep)) - so3_log(at.conjugate() * f(-kStep))) / (2 * kStep);
}

CumulativeBasis uneven_basis() {
  const double knots[6] = {-0.5, 0.1, 0.4, 1.5, 1.7, 3.0};
  return CumulativeBasis::from_knots(knots);
}

TEST(CumulativeBasis, IsTheKnownMatrixOnUniformKnots) {
  const double knots[6] = {0, 1, 2, 3, 4, 5};
  const CumulativeBasis basis = CumulativeBasis::from_knots(knots);
  for (const double u : {0.0, 0.3, 0.7, 1.0}) {
    const Eigen::Array4d b = basis.value(u);
    EXPECT_NEAR(b[0], (5 + 3 * u - 3 * u * u + u * u * u) / 6, 1e-15);
    EXPECT_NEAR(b[1], (1 + 3 * u + 3 * u * u - 2 * u * u * u) / 6, 1e-15);
    EXPECT_NEAR(b[2], u * u * u / 6, 1e-15);
    EXPECT_EQ(b[3], 0);
  }
}

TEST(CumulativeBasis, IsTwiceContinuousAcrossUnevenKnots) {
  const double knots[7] = {-0.5, 0.1, 0.4, 1.5, 1.7, 3.0, 3.1};
  const CumulativeBasis left =
      CumulativeBasis::from_knots(std::span<const double, 6>(&knots[0], 6));
  const CumulativeBasis right =
      CumulativeBasis::from_knots(std::span<const double, 6>(&knots[1], 6));
  const double rate_left = 1 / (knots[3] - knots[2]);
  const double rate_right = 1 / (knots[4] - knots[3]);
  EXPECT_NEAR(left.value(1)[0], 1, 1e-15);  // its control pose is left behind
  EXPECT_NEAR(right.value(0)[2], 0, 1e-15);
  for (int j = 0; j < 2; ++j) {
    EXPECT_NEAR(left.value(1)[j + 1], right.value(0)[j], 1e-14);
    EXPECT_NEAR(rate_left * left.first(1)[j + 1], rate_right * right.first(0)[j], 1e-13);
    EXPECT_NEAR(rate_left * rate_left * left.second(1)[j + 1],
                rate_right * rate_right * right.second(0)[j], 1e-12);
  }
}

TEST(SplineRotation, TurnOverSegmentHasItsDerivative) {
  Eigen::Matrix3d increments;
  increments.col(0) = Vector3d(0.3, -1.2, 0.4);
  increments.col(1) = Vector3d(-0.8, 0.5, 2.0);
  increments.col(2) = Vector3d(1.1, 0.2, -0.7);
  const auto turn = turn_over_segment(uneven_basis(), increments);
  for (int i = 0; i < 9; ++i) {
    const Vector3d expected = difference([&](double d) {
      Eigen::Matrix3d moved = increments;
      moved(i % 3, i / 3) += d;
      return turn_over_segment(uneven_basis(), moved).rotation;
    });
    EXPECT_LT((turn.jacobian.col(i) - expected).norm(), 1e-8) << "parameter " << i;
  }
}

std::array<Quaterniond, 4> some_rotations() {
  return {so3_exp({0.1, 0.2, -0.4}), so3_exp({0.9, -0.3, 0.4}), so3_exp({-0.5, 1.3, 1.0}),
          so3_exp({0.0, 0.4, 2.2})};
}

TEST(SplineRotation, RotationBetweenControlsHasItsDerivative) {
  const auto controls = some_rotations();
  const Eigen::Array4d b = uneven_basis().value(0.37);
  const auto at = rotation_between(b, controls);
  for (int i = 0; i < 12; ++i) {
    const Vector3d expected = difference([&](double d) {
      auto moved = controls;
      auto& control = moved[static_cast<std::size_t>(i / 3)];
      control = control * so3_exp(d * Vector3d::Unit(i % 3));
      return rotation_between(b, moved).rotation;
    });
    EXPECT_LT((at.jacobian.col(i) - expected).norm(), 1e-8) << "parameter " << i;
  }
}

TEST(SplineRotation, UnevennessHasItsDerivativeAndVanishesOnEvenRotation) {
  const auto controls = some_rotations();
  const Unevenness at = unevenness(controls[0], controls[1], controls[2]);
  for (int i = 0; i < 9; ++i) {
    const auto value = [&](double d) {
      auto moved = controls;
      auto& control = moved[static_cast<std::size_t>(i / 3)];
      control = control * so3_exp(d * Vector3d::Unit(i % 3));
      return unevenness(moved[0], moved[1], moved[2]).value;
    };
    const Vector3d expected = (value(kStep) - value(-kStep)) / (2 * kStep);
    EXPECT_LT((at.jacobian.col(i) - expected).norm(), 1e-8) << "parameter " << i;
  }
  const Quaterniond turn = so3_exp({0.2, 0.5, -0.1});
  EXPECT_LT(unevenness(controls[0], controls[0] * turn, controls[0] * turn * turn).value.norm(),
            1e-15);
}

TEST(BandedLeastSquares, SolvesLikeADenseSolver) {
  constexpr int kUnknowns = 12;
  BandedLeastSquares banded(kUnknowns, 3, 2);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * kUnknowns, kUnknowns);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3 * kUnknowns, 2);
  for (int row = 0; row < 3 * kUnknowns; ++row) {
    const int first = row % (kUnknowns - 3);
    const Eigen::RowVector4d j(std::sin(row), std::cos(3.0 * row), 1, 0.1 * row);
    const Eigen::RowVector2d r(row, std::sin(7.0 * row));
    banded.add(first, j, r);
    dense.block<1, 4>(row, first) = j;
    right.row(row) = r;
  }
  const auto x = banded.solve();
  ASSERT_TRUE(x.has_value());
  const Eigen::MatrixXd expected = dense.colPivHouseholderQr().solve(right);
  EXPECT_LT((*x - expected).norm(), 1e-9 * expected.norm());
}

TEST(BandedLeastSquares, ReportsUnknownsThatNoRowTouches) {
  BandedLeastSquares system(3, 1, 1);
  system.add(0, Eigen::RowVector2d(1, 1), Eigen::RowVector<double, 1>(1));
  EXPECT_FALSE(system.solve().has_value());
}

}  // namespace
}  // namespace saccade
