#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/rigid3.h"

namespace saccade {

/// A correction of a camera's path: twists (v, w) of the camera's own frame at nodes even in time,
/// linear between them,
///   world_from_camera(t) = given(t) exp((1 - s) xi_j + s xi_(j+1)).
class NodeCorrection {
 public:
  static constexpr int kSize = 6;

  /// No correction, from start_s to end_s; nodes are about `spacing_s` apart, at least two.
  NodeCorrection(double start_s, double end_s, double spacing_s);

  [[nodiscard]] int count() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] double time_s(int node) const { return start_s_ + node * spacing_s_; }
  /// The six numbers of a node.
  [[nodiscard]] double* data(int node) { return nodes_[static_cast<std::size_t>(node)].data(); }
  [[nodiscard]] const double* data(int node) const {
    return nodes_[static_cast<std::size_t>(node)].data();
  }
  /// Those of all nodes, one after the other.
  [[nodiscard]] std::span<double> unknowns() {
    return {nodes_.front().data(), kSize * nodes_.size()};
  }
  /// The node before a time and the fraction s of the one after it; times are clamped to the ends.
  [[nodiscard]] std::pair<int, double> before(double t_s) const;
  [[nodiscard]] Twist at(double t_s) const;

 private:
  double start_s_;
  std::vector<std::array<double, kSize>> nodes_;
  double spacing_s_;
};

}  // namespace saccade
