#include "simulator/scene/light/vector_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

constexpr double kUnboundedRate = std::numeric_limits<double>::infinity();

struct Ends {
  double low, high;
};

Ends product_of(double a_low, double a_high, double b_low, double b_high) {
  const auto [low, high] =
      std::minmax({a_low * b_low, a_low * b_high, a_high * b_low, a_high * b_high});
  return {low, high};
}

bool is_rate_known(const LightRange& a) {
  return std::isfinite(a.rate_low) && std::isfinite(a.rate_high);
}

LightRange square(const LightRange& a) {
  LightRange result = product(a, a);
  result.low = a.low <= 0 && a.high >= 0 ? 0 : std::min(a.low * a.low, a.high * a.high);
  return result;
}

}  // namespace

LightRange range_near_line(double from, double to, double length_s) {
  const double slack = 0.25 * std::abs(to - from);
  return {std::min(from, to) - slack, std::max(from, to) + slack,
          (to - from - 2 * slack) / length_s, (to - from + 2 * slack) / length_s};
}

VectorRange range_near_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                            double length_s) {
  return {range_near_line(from.x(), to.x(), length_s), range_near_line(from.y(), to.y(), length_s),
          range_near_line(from.z(), to.z(), length_s)};
}

LightRange product(const LightRange& a, const LightRange& b) {
  const Ends values = product_of(a.low, a.high, b.low, b.high);
  if (!is_rate_known(a) || !is_rate_known(b))
    return {values.low, values.high, -kUnboundedRate, kUnboundedRate};
  const Ends first = product_of(a.rate_low, a.rate_high, b.low, b.high);
  const Ends second = product_of(a.low, a.high, b.rate_low, b.rate_high);
  return {values.low, values.high, first.low + second.low, first.high + second.high};
}

LightRange positive_part(LightRange a) {
  if (a.low >= 0) return a;
  return {0, std::max(0.0, a.high), std::min(0.0, a.rate_low), std::max(0.0, a.rate_high)};
}

LightRange dot(const VectorRange& a, const VectorRange& b) {
  LightRange sum = product(a[0], b[0]);
  sum.add(product(a[1], b[1]));
  sum.add(product(a[2], b[2]));
  return sum;
}

VectorRange cross(const VectorRange& a, const VectorRange& b) {
  const auto part = [&](std::size_t i, std::size_t k) {
    const LightRange negative = product(a[k], b[i]);
    LightRange difference = product(a[i], b[k]);
    difference.add({-negative.high, -negative.low, -negative.rate_high, -negative.rate_low});
    return difference;
  };
  return {part(1, 2), part(2, 0), part(0, 1)};
}

VectorRange sum(VectorRange a, const VectorRange& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k].add(b[k]);
  return a;
}

LightRange squared_norm(const VectorRange& vector) {
  LightRange squared = square(vector[0]);
  squared.add(square(vector[1]));
  squared.add(square(vector[2]));
  return squared;
}

VectorRange unit(const VectorRange& vector) {
  constexpr double kLeast = 1e-6;
  const LightRange squared = squared_norm(vector);
  if (!(squared.low > kLeast)) {
    const LightRange any{-1, 1, -kUnboundedRate, kUnboundedRate};
    return {any, any, any};
  }
  // With q the squared length, (q^-1/2)' = -q' / 2 q^-3/2.
  const LightRange cubed{std::pow(squared.high, -1.5), std::pow(squared.low, -1.5), 0, 0};
  const Ends rates =
      product_of(-0.5 * squared.rate_high, -0.5 * squared.rate_low, cubed.low, cubed.high);
  const LightRange inverse{1 / std::sqrt(squared.high), 1 / std::sqrt(squared.low), rates.low,
                           rates.high};
  VectorRange result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = product(vector[k], inverse);
    result[k].low = std::clamp(result[k].low, -1.0, 1.0);
    result[k].high = std::clamp(result[k].high, -1.0, 1.0);
  }
  return result;
}

}  // namespace saccade
