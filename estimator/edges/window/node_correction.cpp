#include "estimator/edges/window/node_correction.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace saccade {
namespace {

std::size_t node_count(double duration_s, double spacing_s) {
  return static_cast<std::size_t>(std::max(2L, 1 + std::lround(duration_s / spacing_s)));
}

}  // namespace

NodeCorrection::NodeCorrection(double start_s, double end_s, double spacing_s)
    : start_s_(start_s),
      nodes_(node_count(end_s - start_s, spacing_s), std::array<double, kSize>{}),
      spacing_s_((end_s - start_s) / (count() - 1)) {}

std::pair<int, double> NodeCorrection::before(double t_s) const {
  const double at = std::clamp((t_s - start_s_) / spacing_s_, 0.0, count() - 1.0);
  const int node = std::min(static_cast<int>(at), count() - 2);
  return {node, at - node};
}

Twist NodeCorrection::at(double t_s) const {
  const auto [node, s] = before(t_s);
  const auto twist = [&](int i) { return Eigen::Map<const Twist>(data(i)); };
  return (1 - s) * twist(node) + s * twist(node + 1);
}

}  // namespace saccade
