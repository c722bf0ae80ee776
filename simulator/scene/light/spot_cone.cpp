#include "simulator/scene/light/spot_cone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

double radians(double deg) { return deg * std::numbers::pi / 180; }

constexpr double kAnyRate = std::numeric_limits<double>::infinity();

/// A point whose way comes nearer to the light than this part of its length may turn about it.
constexpr double kNearest = 0.5;
/// Beside the parabola's own bend, a way may stray from its chord by this part of its length, and
/// the speed along it from the mean by this part.
constexpr double kStraying = 1e-3;
constexpr double kUnevenSpeed = 1e-2;
/// Of what the parabola bends: its cubic part is smaller.
constexpr double kBendMargin = 2;

/// Of the cosine (a + b s) / sqrt(A + 2 B s + C s^2) of the angle between the axis and the way from
/// the light to a point at `from + s * way`.
struct CosineAlong {
  double a, b, A, B, C;

  CosineAlong(const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& way)
      : a(axis.dot(from)),
        b(axis.dot(way)),
        A(from.squaredNorm()),
        B(from.dot(way)),
        C(way.squaredNorm()) {}

  [[nodiscard]] double squared_distance(double s) const { return A + s * (2 * B + s * C); }
  [[nodiscard]] double at(double s) const { return (a + b * s) / std::sqrt(squared_distance(s)); }
  /// The derivative with respect to s, times the cubed distance: linear in s.
  [[nodiscard]] double slope(double s) const { return b * A - a * B + (b * B - a * C) * s; }
  /// Of the least distance, within [0, 1].
  [[nodiscard]] double nearest() const { return std::clamp(-B / C, 0.0, 1.0); }
};

}  // namespace

SpotCone::SpotCone(const LightOptions& light)
    : position_(light.position),
      axis_(light.direction),
      outer_rad_(radians(light.outer_angle_deg)),
      cos_outer_(std::cos(outer_rad_)),
      per_cosine_(1 / (std::cos(radians(light.inner_angle_deg)) - cos_outer_)) {}

double SpotCone::falloff(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d way = point - position_;
  const double part =
      std::clamp((axis_.dot(way) / way.norm() - cos_outer_) * per_cosine_, 0.0, 1.0);
  return part * part;
}

LightRange SpotCone::falloff_range(const Eigen::Vector3d& from, const Eigen::Vector3d& middle,
                                   const Eigen::Vector3d& to, double length_s) const {
  const double bend = (from - 2 * middle + to).norm();
  LightRange range = range_along(from, middle, bend, 0.5 * length_s);
  range.include(range_along(middle, to, bend, 0.5 * length_s));
  return range;
}

LightRange SpotCone::range_along(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                 double bend, double length_s) const {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  const CosineAlong cosine(axis_, from - position_, way);
  const double nearest =
      std::sqrt(length > 0 ? cosine.squared_distance(cosine.nearest()) : cosine.A);
  const double farthest = std::sqrt(std::max(cosine.A, cosine.squared_distance(1)));
  if (!(nearest > kNearest * (length + bend))) return {0, 1, -kAnyRate, kAnyRate};

  std::array<double, 2> values{cosine.at(0), cosine.at(1)};
  std::sort(values.begin(), values.end());
  auto [low, high] = values;
  const std::array<double, 2> slopes{cosine.slope(0), cosine.slope(1)};
  if ((slopes[0] < 0) != (slopes[1] < 0)) {
    const double extremum = cosine.at(slopes[0] / (slopes[0] - slopes[1]));
    low = std::min(low, extremum);
    high = std::max(high, extremum);
  }
  const auto rate = [&](double slope, bool is_high) {
    return slope / std::pow((slope > 0) == is_high ? nearest : farthest, 3);
  };
  double rate_low = rate(std::min(slopes[0], slopes[1]), false);
  double rate_high = rate(std::max(slopes[0], slopes[1]), true);

  // Half of a parabola is off its chord by an eighth of the bend, and its speed off the mean by half
  // the bend. The cosine changes by the sine of the angle per angle.
  const double least = low <= 0 && high >= 0 ? 0 : std::min(std::abs(low), std::abs(high));
  const double turn = (kBendMargin * bend / 8 + kStraying * length) / nearest;
  const double sine = std::min(1.0, std::sqrt(std::max(0.0, 1 - least * least)) + turn);
  const double uneven = (kBendMargin * bend / 2 + kUnevenSpeed * length) / nearest;
  rate_low -= sine * uneven;
  rate_high += sine * uneven;
  return falloff_range(
      {low - sine * turn, high + sine * turn, rate_low / length_s, rate_high / length_s});
}

LightRange SpotCone::falloff_range(const LightRange& cosine) const {
  // f = x^2 with x = clamp((c - cos outer) * per_cosine_, 0, 1); f' = 2 x per_cosine_ c' before the
  // clamp's upper end, 0 beyond.
  const double low = (cosine.low - cos_outer_) * per_cosine_;
  const double high = (cosine.high - cos_outer_) * per_cosine_;
  const double x_low = std::clamp(low, 0.0, 1.0);
  const double x_high = std::clamp(high, 0.0, 1.0);
  const double steepest = low > 1 ? 0 : 2 * x_high * per_cosine_;
  const double flattest = high >= 1 ? 0 : 2 * x_low * per_cosine_;
  return {x_low * x_low, x_high * x_high,
          cosine.rate_low * (cosine.rate_low < 0 ? steepest : flattest),
          cosine.rate_high * (cosine.rate_high > 0 ? steepest : flattest)};
}

bool SpotCone::misses(const Eigen::Vector3d& centre, double radius) const {
  const Eigen::Vector3d way = centre - position_;
  const double distance = way.norm();
  if (!(distance > radius)) return false;
  const double angle = std::atan2(axis_.cross(way).norm(), axis_.dot(way));
  return angle - std::asin(radius / distance) > outer_rad_;
}

}  // namespace saccade
