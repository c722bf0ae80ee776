#include <gtest/gtest.h>
#include <Eigen/QR>

#include "core/rigid3.h"
#include "core/spline/banded.h"
#include "core/spline/rotation.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

template <int Size>
using Vector = Eigen::Matrix<double, Size, 1>;

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
  Vector<9> increments;
  increments << 0.3, -1.2, 0.4, -0.8, 0.5, 2.0, 1.1, 0.2, -0.7;
  const auto turn_of = [](const Vector<9>& w) {
    return rotation_over_segment(uneven_basis(), Eigen::Map<const Eigen::Matrix3d>(w.data()));
  };
  const auto turn = turn_of(increments);
  const auto change = [&](const Vector<9>& w) -> Vector3d {
    return so3_log(turn.rotation.conjugate() * turn_of(w).rotation);
  };
  testing::expect_jacobian<3, 9>(turn.jacobian, change, increments);
}

std::array<Quaterniond, 4> some_rotations() {
  return {so3_exp({0.1, 0.2, -0.4}), so3_exp({0.9, -0.3, 0.4}), so3_exp({-0.5, 1.3, 1.0}),
          so3_exp({0.0, 0.4, 2.2})};
}

/// some_rotations() after right perturbations.
std::array<Quaterniond, 4> perturbed(const Vector<12>& d) {
  auto controls = some_rotations();
  for (int k = 0; k < 4; ++k) {
    auto& control = controls[static_cast<std::size_t>(k)];
    control = control * so3_exp(d.segment<3>(3 * k));
  }
  return controls;
}

TEST(SplineRotation, RotationBetweenControlsHasItsDerivative) {
  const Eigen::Array4d b = uneven_basis().value(0.37);
  const auto at = rotation_between(b, some_rotations());
  const auto change = [&](const Vector<12>& d) -> Vector3d {
    return so3_log(at.rotation.conjugate() * rotation_between(b, perturbed(d)).rotation);
  };
  testing::expect_jacobian<3, 12>(at.jacobian, change, Vector<12>::Zero());
}

TEST(SplineRotation, SecondDifferenceHasItsDerivativeAndVanishesAtConstantVelocity) {
  const auto controls = some_rotations();
  const auto value = [](const Vector<9>& d) -> Vector3d {
    const auto moved = perturbed((Vector<12>() << d, 0, 0, 0).finished());
    return rotation_second_difference(moved[0], moved[1], moved[2]).value;
  };
  const RotationSecondDifference at =
      rotation_second_difference(controls[0], controls[1], controls[2]);
  testing::expect_jacobian<3, 9>(at.jacobian, value, Vector<9>::Zero());
  const Quaterniond turn = so3_exp({0.2, 0.5, -0.1});
  EXPECT_LT(rotation_second_difference(controls[0], controls[0] * turn, controls[0] * turn * turn)
                .value.norm(),
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
