#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace saccade {

/// The cumulative cubic basis of one segment in u = (t - start) / length, 0..1:
///   B_j(u) = sum_k power[k][j-1] u^k,  j = 1..3.
/// A fourth lane of zeros keeps the arithmetic in whole vector registers.
struct CumulativeBasis {
  Eigen::Array4d power[4];

  /// `knots`: the six around the segment [knots[2], knots[3]], strictly increasing. B_j' are the
  /// quadratic B-splines over these knots, so B_1 = 1 - a (1 - u)^3, B_3 = b u^3, and B_2 is the
  /// integral of what is left to one.
  [[nodiscard]] static CumulativeBasis from_knots(std::span<const double, 6> knots);

  [[nodiscard]] Eigen::Array4d value(double u) const {
    return power[0] + u * (power[1] + u * (power[2] + u * power[3]));
  }
  /// d/du and d^2/du^2.
  [[nodiscard]] Eigen::Array4d first(double u) const {
    return power[1] + u * (2 * power[2] + u * (3 * power[3]));
  }
  [[nodiscard]] Eigen::Array4d second(double u) const { return 2 * power[2] + u * (6 * power[3]); }
};

/// The bases of all segments between the strictly increasing `times` (at least two). Beyond both
/// ends two more knots follow at the distance of the outermost interval.
[[nodiscard]] std::vector<CumulativeBasis> bases_between(std::span<const double> times);

/// One piece between two knots, in the form that is quickest to evaluate.
struct SplineSegment {
  double start_s = 0;
  double inverse_length = 1;             ///< [1/s]
  Eigen::Matrix<double, 3, 4> position;  ///< p(u) = sum_k col(k) u^k [m]
  CumulativeBasis basis;
  Eigen::Quaterniond first_rotation;   ///< of control pose 0
  Eigen::Matrix3d half_increments;     ///< col(j-1) = Omega_j / 2, R_j = R_{j-1} Exp(Omega_j) [rad]
  Eigen::Array4d half_angles_squared;  ///< |Omega_j / 2|^2 and a zero
  bool small_angles = false;           ///< all within reach of the series of sine and cosine

  /// `position`: of control pose 0, `steps.col(j-1)` = p_j - p_{j-1}; `increments.col(j-1)` =
  /// Omega_j.
  SplineSegment(double start, double length, const CumulativeBasis& cumulative_basis,
                const Eigen::Vector3d& first_position, const Eigen::Matrix3d& steps,
                const Eigen::Quaterniond& rotation, const Eigen::Matrix3d& increments);

  /// The factors Exp(B_j Omega_j), j = 1..3, for the given values of the basis.
  void factors(const Eigen::Array4d& basis_value, Eigen::Quaterniond out[3]) const;
};

}  // namespace saccade
