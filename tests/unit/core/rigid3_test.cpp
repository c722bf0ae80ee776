#include "core/rigid3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "tests/support/jacobian_check.h"

namespace saccade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::expect_jacobian;

constexpr double kPi = std::numbers::pi;

Vector3d random_vector(std::uint64_t index, std::uint64_t stream = 0) {
  const Random random(7);
  return {random.normal(3 * stream, index), random.normal(3 * stream + 1, index),
          random.normal(3 * stream + 2, index)};
}

/// Angles where closed forms and series meet, and both ends.
const std::vector<double> kAngles{0,    1e-12, 1e-9, 1e-6, 1e-4, 9.9e-3, 1.01e-2,
                                  0.05, 0.199, 0.21, 1,    2,    3,      kPi - 1e-3};

std::vector<Vector3d> rotation_vectors() {
  std::vector<Vector3d> vectors;
  for (std::size_t i = 0; i < kAngles.size(); ++i)
    vectors.push_back(kAngles[i] * random_vector(i).normalized());
  return vectors;
}

Twist twist_of(const Vector3d& v, const Vector3d& w) {
  Twist twist;
  twist << v, w;
  return twist;
}

TEST(So3, ExpThenLogIsIdentity) {
  for (const Vector3d& w : rotation_vectors())
    EXPECT_LT((so3_log(so3_exp(w)) - w).norm(), 1e-14 + 1e-14 * w.norm()) << w.norm();
}

TEST(So3, LogNearPiKeepsTheRotation) {
  for (const double angle : {kPi - 1e-6, kPi - 1e-9, kPi, kPi + 1e-9, 4.0, 6.2}) {
    const Eigen::Quaterniond q = so3_exp(angle * Vector3d(1, 2, -2).normalized());
    const Vector3d log = so3_log(q);
    EXPECT_LE(log.norm(), kPi + 1e-12);
    EXPECT_LT(angle_between(so3_exp(log), q), 1e-12) << angle;
  }
}

TEST(So3, LogIgnoresTheSignOfTheQuaternion) {
  const Eigen::Quaterniond q = so3_exp({0.3, -1, 0.7});
  const Eigen::Quaterniond minus(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT((so3_log(q) - so3_log(minus)).norm(), 1e-15);
}

TEST(So3, ExpMatchesRodrigues) {
  for (const Vector3d& w : rotation_vectors()) {
    const Matrix3d expected = w.norm() == 0
                                  ? Matrix3d::Identity().eval()
                                  : Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    EXPECT_LT((so3_exp(w).toRotationMatrix() - expected).norm(), 1e-14) << w.norm();
  }
}

TEST(So3, LeftJacobianIsTheDerivative) {
  for (const Vector3d& w : rotation_vectors()) {
    const auto moved = [&](const Vector3d& dw) -> Vector3d {
      return so3_log(so3_exp(w + dw) * so3_exp(w).conjugate());
    };
    expect_jacobian(so3_left_jacobian(w), moved, Vector3d::Zero().eval());
    EXPECT_LT((so3_left_jacobian(w) * so3_left_jacobian_inverse(w) - Matrix3d::Identity()).norm(),
              1e-12);
  }
}

TEST(Rigid3, ExpThenLogIsIdentity) {
  for (const Vector3d& w : rotation_vectors()) {
    const Twist twist = twist_of({0.4, -2, 1.5}, w);
    EXPECT_LT((Rigid3::exp(twist).log() - twist).norm(), 1e-12) << w.norm();
  }
}

TEST(Rigid3, LogThenExpIsIdentityUpToPi) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Rigid3 t(so3_exp(kPi * random_vector(i).normalized()), random_vector(i, 1));
    const Rigid3 error = t.inverse() * Rigid3::exp(t.log());
    EXPECT_LT(error.log().norm(), 1e-9);
  }
}

TEST(Rigid3, ExpIntegratesAConstantVelocity) {
  const Twist twist = twist_of({1, -0.5, 2}, {0.3, 1.2, -0.8});
  const Rigid3 half = Rigid3::exp(0.5 * twist);
  EXPECT_LT(((half * half).inverse() * Rigid3::exp(twist)).log().norm(), 1e-14);
}

TEST(Rigid3, ProductsAndInverse) {
  const Rigid3 a(so3_exp({0.3, 0.1, -2}), {1, 2, 3});
  const Rigid3 b(so3_exp({-0.7, 1, 0.2}), {-4, 0.5, 1});
  const Vector3d p(0.2, -0.3, 5);
  EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-14);
  EXPECT_LT((a.inverse() * (a * p) - p).norm(), 1e-14);
}

TEST(Rigid3, AdjointMovesATwistToTheOtherSide) {
  const Rigid3 t(so3_exp({0.3, 0.1, -2}), {1, 2, 3});
  const Twist twist = twist_of({0.1, 0.2, -0.1}, {0.2, -0.3, 0.1});
  const Rigid3 left = t * Rigid3::exp(twist) * t.inverse();
  const Rigid3 right = Rigid3::exp(t.adjoint() * twist);
  EXPECT_LT((left.inverse() * right).log().norm(), 1e-13);
}

TEST(Rigid3, PointJacobianIsTheDerivative) {
  const Vector3d p(0.4, -1, 2.5);
  const auto moved = [&](const Twist& twist) -> Vector3d { return Rigid3::exp(twist) * p; };
  expect_jacobian(point_jacobian(p), moved, Twist::Zero().eval());
}

TEST(Rigid3, LeftJacobianIsTheDerivative) {
  for (const Vector3d& w : rotation_vectors()) {
    const Twist twist = twist_of({0.4, -0.7, 1.1}, w);
    const auto moved = [&](const Twist& d) -> Twist {
      return (Rigid3::exp(twist + d) * Rigid3::exp(twist).inverse()).log();
    };
    expect_jacobian(se3_left_jacobian(twist), moved, Twist::Zero().eval());
  }
}

TEST(Rigid3, AngleBetweenKeepsSmallAngles) {
  const Eigen::Quaterniond q = so3_exp({1, 2, 0.5});
  EXPECT_NEAR(angle_between(q, q * so3_exp({0, 1e-10, 0})), 1e-10, 1e-15);
  EXPECT_NEAR(angle_between(q, q * so3_exp({kPi, 0, 0})), kPi, 1e-12);
}

TEST(Rigid3, InterpolationRunsFromOneEndToTheOther) {
  const Rigid3 a(so3_exp({0.3, 0.1, -1}), {1, 2, 3});
  const Rigid3 b(so3_exp({-0.7, 1, 0.2}), {-4, 0.5, 1});
  EXPECT_LT((interpolate(a, b, 0).inverse() * a).log().norm(), 1e-12);
  EXPECT_LT((interpolate(a, b, 1).inverse() * b).log().norm(), 1e-12);
  const Rigid3 quarter = interpolate(a, b, 0.25);
  EXPECT_NEAR(angle_between(a.rotation(), quarter.rotation()),
              0.25 * angle_between(a.rotation(), b.rotation()), 1e-12);
  EXPECT_LT((quarter.translation() - Vector3d(-0.25, 1.625, 2.5)).norm(), 1e-14);
}

}  // namespace
}  // namespace saccade
