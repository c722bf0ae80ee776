#include "core/spline/rotation.h"

#include "core/rigid3.h"

namespace saccade {
namespace {

using Jacobian = Eigen::Matrix3d;

/// Exp((w + d)^) = Exp(w^) Exp((J d)^) to first order; J is the left Jacobian of -w.
Jacobian right_jacobian(const Eigen::Vector3d& w) { return so3_left_jacobian(-w); }

/// Log(a^-1 b) and its derivatives by right perturbations of a and b.
struct Increment {
  Eigen::Vector3d value;
  Jacobian by_a, by_b;

  Increment(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b)
      : value(so3_log(a.conjugate() * b)),
        by_a(-so3_left_jacobian_inverse(value)),
        by_b(so3_left_jacobian_inverse(-value)) {}
};

}  // namespace

RotationWithJacobian<9> rotation_over_segment(const CumulativeBasis& basis,
                                              const Eigen::Matrix3d& increments) {
  const Eigen::Array4d start = basis.value(0);
  const Eigen::Array4d end = basis.value(1);
  const double scale[4] = {-start[1], 1 - start[0], end[1], end[2]};
  const int parameter[4] = {1, 0, 1, 2};

  RotationWithJacobian<9> product{Eigen::Quaterniond::Identity(),
                                  Eigen::Matrix<double, 3, 9>::Zero()};
  Jacobian after = Jacobian::Identity();  // transpose of the product of the factors behind this one
  for (int f = 3; f >= 0; --f) {
    const Eigen::Vector3d angle = scale[f] * increments.col(parameter[f]);
    const Eigen::Quaterniond factor = so3_exp(angle);
    product.jacobian.middleCols<3>(3 * parameter[f]) += after * right_jacobian(angle) * scale[f];
    product.rotation = factor * product.rotation;
    after = product.rotation.toRotationMatrix().transpose();
  }
  return product;
}

RotationWithJacobian<12> rotation_between(const Eigen::Array4d& basis_value,
                                          const std::array<Eigen::Quaterniond, 4>& controls) {
  RotationWithJacobian<12> result{Eigen::Quaterniond::Identity(),
                                  Eigen::Matrix<double, 3, 12>::Zero()};
  Jacobian after = Jacobian::Identity();
  for (int j = 3; j >= 1; --j) {
    const auto k = static_cast<std::size_t>(j);
    const Increment increment(controls[k - 1], controls[k]);
    const double b = basis_value[j - 1];
    const Eigen::Vector3d angle = b * increment.value;
    const Jacobian by_increment = after * right_jacobian(angle) * b;
    result.jacobian.middleCols<3>(3 * (j - 1)) += by_increment * increment.by_a;
    result.jacobian.middleCols<3>(3 * j) += by_increment * increment.by_b;
    result.rotation = so3_exp(angle) * result.rotation;
    after = result.rotation.toRotationMatrix().transpose();
  }
  result.jacobian.leftCols<3>() += after;
  result.rotation = controls[0] * result.rotation;
  return result;
}

RotationSecondDifference rotation_second_difference(const Eigen::Quaterniond& a,
                                                    const Eigen::Quaterniond& b,
                                                    const Eigen::Quaterniond& c) {
  const Increment first(a, b);
  const Increment second(b, c);
  RotationSecondDifference result;
  result.value = second.value - first.value;
  result.jacobian << -first.by_a, second.by_a - first.by_b, second.by_b;
  return result;
}

}  // namespace saccade
