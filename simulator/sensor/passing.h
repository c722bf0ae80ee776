#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "simulator/scene/scene.h"

namespace saccade {

/// A triangle that may pass through rays of a tile between two looks, with its edges at both.
struct PassingTriangle {
  TriangleId triangle;
  TrianglePass from, to;

  /// Whether one edge keeps all rays within `outline` out at both looks.
  [[nodiscard]] bool misses(const std::array<Eigen::Vector3d, 4>& outline) const {
    const auto is_outside = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::all_of(outline.begin(), outline.end(), [&](const Eigen::Vector3d& corner) {
        return a.dot(corner) < 0 && b.dot(corner) < 0;
      });
    };
    if (is_outside(from.w, to.w)) return true;
    for (std::size_t k = 0; k < from.edges.size(); ++k)
      if (is_outside(from.edges[k], to.edges[k])) return true;
    return false;
  }

  /// The middle of the share of the way from one look to the other in which the ray `direction` is
  /// inside the edges and meets the triangle nearer than `hidden_beyond`; NaN where it never is.
  /// The ray's way over the triangle's image is taken to be even.
  [[nodiscard]] double passing_fraction(const Eigen::Vector3d& direction,
                                        double hidden_beyond) const {
    constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
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
    return low < high ? 0.5 * (low + high) : kNever;
  }
};

}  // namespace saccade
