#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "simulator/scene/scene.h"

namespace saccade {

/// A triangle that may pass through rays of a tile between two looks, with its edges at both and
/// half way, where the motion may have turned. Its ways over the image are taken to be even in both
/// halves.
struct PassingTriangle {
  TriangleId triangle;
  std::array<TrianglePass, 3> at;

  /// Whether one edge keeps all rays within `outline` out all the time.
  [[nodiscard]] bool misses(const std::array<Eigen::Vector3d, 4>& outline) const {
    const auto is_outside = [&](const auto& form) {
      return std::all_of(at.begin(), at.end(), [&](const TrianglePass& pass) {
        return std::all_of(outline.begin(), outline.end(), [&](const Eigen::Vector3d& corner) {
          return form(pass).dot(corner) < 0;
        });
      });
    };
    if (is_outside([](const TrianglePass& pass) { return pass.w; })) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (is_outside([k](const TrianglePass& pass) { return pass.edges[k]; })) return true;
    return false;
  }

  /// Whether the ray `direction`, inside the edges at both looks, is outside half way.
  [[nodiscard]] bool leaves(const Eigen::Vector3d& direction) const {
    return std::any_of(at[1].edges.begin(), at[1].edges.end(),
                       [&](const Eigen::Vector3d& edge) { return edge.dot(direction) < 0; });
  }

  /// The middle of the share of half `half` (0 or 1) in which the ray `direction` is inside the
  /// edges and meets the triangle nearer than `hidden_beyond`, as a fraction of the whole; NaN
  /// where it never is.
  [[nodiscard]] double passing_fraction(const Eigen::Vector3d& direction, double hidden_beyond,
                                        std::size_t half) const {
    constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
    const TrianglePass& from = at[half];
    const TrianglePass& to = at[half + 1];
    const double a = from.w.dot(direction) / from.depth;  // inverse distances
    const double b = to.w.dot(direction) / to.depth;
    if (!(a > 0 && b > 0) || std::max(a, b) * hidden_beyond < 1) return kNever;
    double low = 0;
    double high = 1;
    for (std::size_t k = 0; k < from.edges.size(); ++k) {
      // Weights over distances are affine in the image.
      const double x = from.edges[k].dot(direction) / from.depth;
      const double y = to.edges[k].dot(direction) / to.depth;
      if (x < 0 && y < 0) return kNever;
      if (x < 0) low = std::max(low, x / (x - y));
      if (y < 0) high = std::min(high, x / (x - y));
    }
    return low < high ? 0.5 * (static_cast<double>(half) + 0.5 * (low + high)) : kNever;
  }
};

}  // namespace saccade
