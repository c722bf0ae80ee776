#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/visibility/transit.h"

namespace saccade {

/// Bounds of the parabola through three values at even distances.
inline Interval parabola_bounds(double from, double middle, double to) {
  const double control = 2 * middle - 0.5 * (from + to);  // where the tangents at both ends meet
  return {std::min({from, to, control}), std::max({from, to, control})};
}

/// How a triangle lies to the ray of a pixel during an interval of time. Its forms along the ray
/// are taken to be parabolas in time; what is nearer to an edge than `margin` of the image plane is
/// in doubt.
class TriangleRayBounds {
 public:
  TriangleRayBounds(const TransitTriangle& triangle, const Eigen::Vector3d& direction,
                    double margin)
      : triangle_(triangle), direction_(direction), margin_(margin) {
    const Interval w = along([](const EdgeFunctions& pass) { return pass.w; });
    side_ = w.low > 0 ? 1 : w.high < 0 ? -1 : 0;
  }

  /// Whether the ray is inside all edges all the time.
  [[nodiscard]] bool stays_inside() const {
    if (side_ == 0) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Interval edge = from_edge(k);
      if (!((side_ > 0 ? edge.low : -edge.high) > reach(k))) return false;
    }
    return true;
  }

  /// The edge through which the ray, inside the others all the time, goes out of the triangle once,
  /// or with `inwards` comes in.
  [[nodiscard]] std::optional<std::size_t> edge_crossed(bool inwards) const {
    std::optional<std::size_t> passed;
    for (std::size_t k = 0; k < 3 && side_ != 0; ++k) {
      const Interval edge = from_edge(k);
      if ((side_ > 0 ? edge.low : -edge.high) > reach(k)) continue;
      const double from = side_ * triangle_.at[0].edges[k].dot(direction_);
      const double to = side_ * triangle_.at[2].edges[k].dot(direction_);
      // A parabola between two signs has one root.
      const bool is_passed = (inwards ? to : from) > reach(k) && (inwards ? from : to) < -reach(k);
      if (passed || !is_passed) return std::nullopt;
      passed = k;
    }
    return passed;
  }

  /// When, as a fraction of the interval, the ray crosses such an edge.
  [[nodiscard]] double crossing(std::size_t k) const {
    const double from = triangle_.at[0].edges[k].dot(direction_);
    const double middle = triangle_.at[1].edges[k].dot(direction_);
    const double to = triangle_.at[2].edges[k].dot(direction_);
    // from + u (slope + bend u) = 0; the root between two signs, without cancellation.
    const double bend = 2 * (from - 2 * middle + to);
    const double slope = to - from - bend;
    const double root = std::sqrt(std::max(slope * slope - 4 * bend * from, 0.0));
    return -2 * from / (slope + (to > from ? root : -root));
  }

  /// Whether it is outside one of them all the time.
  [[nodiscard]] bool stays_outside() const {
    if (side_ == 0) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Interval edge = from_edge(k);
      if ((side_ > 0 ? edge.high : -edge.low) < -reach(k)) return true;
    }
    return false;
  }

  /// Whether the triangle's plane is behind another one's, or behind the eye, all the time.
  [[nodiscard]] bool stays_behind(const TransitTriangle& other) const {
    for (std::size_t m = 0; m < 3; ++m)
      if (!(nearness(triangle_.at[m]) < kBehind * nearness(other.at[m]))) return false;
    return true;
  }

 private:
  static constexpr double kBehind = 0.999;

  template <class Form>
  [[nodiscard]] Interval along(const Form& form) const {
    const auto& at = triangle_.at;
    return parabola_bounds(form(at[0]).dot(direction_), form(at[1]).dot(direction_),
                           form(at[2]).dot(direction_));
  }
  [[nodiscard]] Interval from_edge(std::size_t k) const {
    return along([k](const EdgeFunctions& pass) { return pass.edges[k]; });
  }
  /// What the form of edge `k` amounts to at the margin.
  [[nodiscard]] double reach(std::size_t k) const {
    return margin_ * triangle_.at[1].edges[k].head<2>().norm();
  }
  /// Inverse distance.
  [[nodiscard]] double nearness(const EdgeFunctions& pass) const {
    return pass.w.dot(direction_) / pass.depth;
  }

  const TransitTriangle& triangle_;
  const Eigen::Vector3d& direction_;
  double margin_;
  int side_;
};

}  // namespace saccade
