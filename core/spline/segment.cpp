#include "core/spline/segment.h"

#include <array>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

// Up to this squared half angle the series below are exact to 1e-17.
constexpr double kSeriesReach = 0.6;

/// cos x and sin(x)/x of x^2 = s, lane by lane; s in [0, kSeriesReach].
void cosine_and_sinc(const Eigen::Array4d& s, Eigen::Array4d& cosine, Eigen::Array4d& sinc) {
  constexpr int kTerms = 8;
  cosine = sinc = Eigen::Array4d::Ones();
  for (int k = kTerms; k >= 1; --k) {
    cosine = 1 - s * cosine * (1.0 / ((2 * k - 1) * (2 * k)));
    sinc = 1 - s * sinc * (1.0 / ((2 * k) * (2 * k + 1)));
  }
}

void cosine_and_sinc_of_large(const Eigen::Array4d& s, Eigen::Array4d& cosine,
                              Eigen::Array4d& sinc) {
  for (int j = 0; j < 4; ++j) {
    const double x = std::sqrt(s[j]);
    cosine[j] = std::cos(x);
    sinc[j] = x > 1e-4 ? std::sin(x) / x : 1 - s[j] / 6;
  }
}

}  // namespace

CumulativeBasis CumulativeBasis::from_knots(std::span<const double, 6> knots) {
  const auto& k = knots;
  const double h = k[3] - k[2];
  const double a = h * h / ((k[3] - k[1]) * (k[3] - k[0]));
  const double b = h * h / ((k[4] - k[2]) * (k[5] - k[2]));
  // B_2 = B_2(0) + g (u - left (u - u^2 + u^3 / 3) - right u^3 / 3)
  const double g = 3 * h / (k[4] - k[1]);
  const double left = h / (k[3] - k[1]);
  const double right = h / (k[4] - k[2]);
  const double at_start = (k[2] - k[1]) * (k[2] - k[1]) / ((k[3] - k[1]) * (k[4] - k[1]));
  CumulativeBasis basis;
  basis.power[0] << 1 - a, at_start, 0, 0;
  basis.power[1] << 3 * a, g * (1 - left), 0, 0;
  basis.power[2] << -3 * a, g * left, 0, 0;
  basis.power[3] << a, -g * (left + right) / 3, b, 0;
  return basis;
}

std::vector<CumulativeBasis> bases_between(std::span<const double> times) {
  SACCADE_CHECK(times.size() >= 2);
  const double first = times[1] - times[0];
  const double last = times.back() - times[times.size() - 2];
  std::vector<double> knots = {times[0] - 2 * first, times[0] - first};
  knots.insert(knots.end(), times.begin(), times.end());
  knots.insert(knots.end(), {times.back() + last, times.back() + 2 * last});

  std::vector<CumulativeBasis> bases;
  bases.reserve(times.size() - 1);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    bases.push_back(CumulativeBasis::from_knots(std::span<const double, 6>(&knots[i], 6)));
  }
  return bases;
}

SplineSegment::SplineSegment(double start, double length, const CumulativeBasis& cumulative_basis,
                             const Eigen::Vector3d& first_position, const Eigen::Matrix3d& steps,
                             const Eigen::Quaterniond& rotation, const Eigen::Matrix3d& increments)
    : start_s(start),
      inverse_length(1 / length),
      basis(cumulative_basis),
      first_rotation(rotation),
      half_increments(0.5 * increments) {
  for (int k = 0; k < 4; ++k) position.col(k) = steps * basis.power[k].head<3>().matrix();
  position.col(0) += first_position;
  half_angles_squared << half_increments.colwise().squaredNorm().transpose().array(), 0;
  small_angles = half_angles_squared.maxCoeff() <= kSeriesReach;
}

void SplineSegment::factors(const Eigen::Array4d& basis_value, Eigen::Quaterniond out[3]) const {
  const Eigen::Array4d squares = basis_value.square() * half_angles_squared;
  Eigen::Array4d cosine, sinc;
  if (small_angles) {
    cosine_and_sinc(squares, cosine, sinc);
  } else {
    cosine_and_sinc_of_large(squares, cosine, sinc);
  }
  const Eigen::Array4d scale = sinc * basis_value;
  for (int j = 0; j < 3; ++j) {
    out[j].w() = cosine[j];
    out[j].vec() = scale[j] * half_increments.col(j);
  }
}

}  // namespace saccade
