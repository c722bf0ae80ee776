#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "simulator/scene/scene.h"

namespace saccade {

/// Five values of the parabola through three, at its quarters.
[[nodiscard]] inline std::array<double, 5> parabola_quarters(const std::array<double, 3>& values) {
  const auto [a, b, c] = values;
  return {a, 0.125 * (3 * a + 6 * b - c), b, 0.125 * (3 * c + 6 * b - a), c};
}

/// Keeps of [low, high] where the line from x at 0 to y at 1 is not negative.
inline void clip_to_line(double x, double y, double& low, double& high) {
  if (x < 0 && y < 0) high = -1;
  if (x < 0 && y >= 0) low = std::max(low, x / (x - y));
  if (y < 0 && x >= 0) high = std::min(high, x / (x - y));
}

/// use(begin, end), as fractions of the interval, with each part of it in which none of the linear
/// forms (edge functions of a ray) is negative. Each form is given at both ends and in the middle,
/// and taken to be the parabola through these values, linear between its quarters.
template <std::size_t kForms, class Use>
void find_intervals(const std::array<std::array<double, 3>, kForms>& forms, const Use& use) {
  std::array<std::array<double, 5>, kForms> quarters;
  for (std::size_t k = 0; k < kForms; ++k) {
    quarters[k] = parabola_quarters(forms[k]);
    if (std::all_of(quarters[k].begin(), quarters[k].end(), [](double x) { return x < 0; })) return;
  }
  double begin = 0;
  double end = -1;  // nothing is open
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    double low = 0;
    double high = 1;
    for (const std::array<double, 5>& form : quarters)
      clip_to_line(form[quarter], form[quarter + 1], low, high);
    if (low >= high) continue;
    const double from = 0.25 * (static_cast<double>(quarter) + low);
    if (end >= begin && from > end) use(begin, end);
    if (end < begin || from > end) begin = from;
    end = 0.25 * (static_cast<double>(quarter) + high);
  }
  if (end >= begin) use(begin, end);
}

/// A triangle that may pass through rays of a tile between two samples, with its edges at both and
/// in the middle. Each edge's form along a ray is taken to be the parabola through these, and even
/// between its quarters: exact enough for what is seen edge-on, too, because the forms are smooth
/// while the triangle turns from one side to the other.
struct TransitTriangle {
  TriangleId triangle;
  std::array<EdgeFunctions, 3> at;

  /// Whether, turned either way, some edge keeps all rays within `outline` out all the time.
  [[nodiscard]] bool misses(const std::array<Eigen::Vector3d, 4>& outline) const {
    const auto is_negative = [&](double sign, const auto& form) {
      return std::all_of(at.begin(), at.end(), [&](const EdgeFunctions& pass) {
        return std::all_of(outline.begin(), outline.end(), [&](const Eigen::Vector3d& corner) {
          return sign * form(pass).dot(corner) < 0;
        });
      });
    };
    const auto is_outside = [&](double sign) {
      if (is_negative(sign, [](const EdgeFunctions& pass) { return pass.w; })) return true;
      for (std::size_t k = 0; k < 3; ++k)
        if (is_negative(sign, [k](const EdgeFunctions& pass) { return pass.edges[k]; }))
          return true;
      return false;
    };
    return is_outside(1) && is_outside(-1);
  }

  /// Whether the ray `direction`, inside the edges at both samples, is outside in the middle.
  [[nodiscard]] bool leaves(const Eigen::Vector3d& direction) const {
    const double sign = at[1].w.dot(direction) < 0 ? -1 : 1;
    return std::any_of(at[1].edges.begin(), at[1].edges.end(),
                       [&](const Eigen::Vector3d& edge) { return sign * edge.dot(direction) < 0; });
  }

  /// Whether the ray `direction` intersects the plane behind `occluded_beyond`, or behind the
  /// camera, at both samples and in the middle. Where it grazes the plane, its distance is
  /// undefined.
  [[nodiscard]] bool is_occluded(const Eigen::Vector3d& direction, double occluded_beyond) const {
    constexpr double kGrazing = 1e-2;
    constexpr double kMargin = 1.001;
    return std::all_of(at.begin(), at.end(), [&](const EdgeFunctions& pass) {
      const double w = pass.w.dot(direction);
      const double distance = pass.depth / w;
      return std::abs(w) > kGrazing && !(distance > 0 && distance < kMargin * occluded_beyond);
    });
  }

  /// use(begin, end), as fractions of the whole, with each time during which the ray `direction` is
  /// inside the edges.
  template <class Use>
  void find_transits(const Eigen::Vector3d& direction, const Use& use) const {
    for (const double sign : {1.0, -1.0}) {
      std::array<std::array<double, 3>, 3> forms;
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t m = 0; m < 3; ++m) forms[k][m] = sign * at[m].edges[k].dot(direction);
      find_intervals(forms, use);
    }
  }
};

}  // namespace saccade
