#include "estimator/reconstruction/surface/plane_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "core/check.h"

namespace saccade {
namespace {

// The sum that is minimised, see the header.
constexpr float kDiscontinuityCost = 1;       ///< tau: per pixel of length
constexpr float kFullDiscontinuity = 0.05F;   ///< s: relative change of depth that costs tau
constexpr float kHiddenCost = 1;              ///< most_k of a point behind the surface
constexpr float kOutlierCost = 6;             ///< most_k of a point in front of it
constexpr float kSurfaceModelError = 0.003F;  ///< relative, of a surface from its planes
constexpr float kNearnessCost = 0.02F;        ///< n: per log inverse depth
constexpr float kDistanceCost = 0.002F;       ///< d: per pixel from the points on the plane
constexpr float kSlopeCost = 0.05F;           ///< g: per log inverse depth per pixel

constexpr float kLeastGain = 1;      ///< of points, for which a plane is tried
constexpr float kSupport = 1;        ///< misfit of a pixel whose points a plane passes through
constexpr float kFarthest_px = 100;  ///< from points on a plane; beyond it costs no more
constexpr float kSteepest = 0.1F;    ///< [1/px]; beyond it costs no more

/// Half of the neighbours of a pixel, and the length of border that a pair stands for (Boykov and
/// Kolmogorov, ICCV 2003).
struct Neighbour {
  int dx, dy;
  float length;
};
constexpr std::array<Neighbour, 4> kNeighbours = {
    {{1, 0, 0.393F}, {0, 1, 0.393F}, {1, 1, 0.278F}, {-1, 1, 0.278F}}};

}  // namespace

/// An expansion move on a rectangle, by a minimum cut: pixels on the source's side keep their plane,
/// those on the sink's side take the new one.
struct PlaneLabels::ExpansionMove {
  ExpansionMove(int first_x, int first_y, int width, int height)
      : left(first_x),
        top(first_y),
        offer(width, height),
        keep(offer.size(), 0.F),
        take(offer.size(), 0.F),
        graph(static_cast<unsigned>(offer.size()),
              static_cast<unsigned>(2 * kNeighbours.size() * offer.size())) {
    for (std::size_t i = 0; i < offer.size(); ++i) graph.addVtx();
  }

  [[nodiscard]] bool contains(int x, int y) const {
    return x >= 0 && y >= 0 && x < offer.width() && y < offer.height();
  }
  [[nodiscard]] std::size_t node(int x, int y) const {
    return static_cast<std::size_t>(y * offer.width() + x);
  }

  /// Costs of a pair where both keep their plane, where only the second or only the first takes the new
  /// one; 0 if both take it.
  void add_pair(std::size_t i, std::size_t j, float keep_both, float second, float first) {
    keep[i] += keep_both;
    take[i] += first;
    take[j] -= first;
    const float cut = second + first - keep_both;
    if (!(cut > 0)) return;
    graph.addEdges(static_cast<int>(i), static_cast<int>(j), cut, 0.F);
    has_edges = true;
  }

  void solve() {
    for (std::size_t i = 0; i < keep.size(); ++i) {
      const float least = std::min(keep[i], take[i]);
      graph.addTermWeights(static_cast<int>(i), take[i] - least, keep[i] - least);
    }
    if (has_edges) graph.maxFlow();  // not defined for a graph without edges
  }

  /// Whether a pixel takes the new plane, after solve().
  [[nodiscard]] bool takes(std::size_t i) const {
    return has_edges ? !graph.inSourceSegment(static_cast<int>(i)) : take[i] < keep[i];
  }

  int left, top;
  Image<PlaneValue> offer;  ///< the new plane at the pixels of the rectangle
  std::vector<float> keep, take;
  mutable cv::detail::GCGraph<float> graph;  ///< its queries are not const
  bool has_edges = false;
};

PlaneLabels::PlaneLabels(int width, int height, std::span<const SurfaceAnchor> anchors,
                         std::span<const InverseDepthPlane> planes)
    : farthest_(std::numeric_limits<float>::infinity()), values_(width, height) {
  SACCADE_CHECK(!anchors.empty() && anchors.size() == planes.size());
  sort_by_pixel(anchors);
  spread(anchors, planes);
}

std::size_t PlaneLabels::pixel_of(const SurfaceAnchor& anchor) const {
  return index(std::clamp(static_cast<int>(std::lround(anchor.x_px)), 0, values_.width() - 1),
               std::clamp(static_cast<int>(std::lround(anchor.y_px)), 0, values_.height() - 1));
}

void PlaneLabels::sort_by_pixel(std::span<const SurfaceAnchor> anchors) {
  points_.resize(anchors.size());
  begin_.assign(values_.size() + 1, 0);
  for (const SurfaceAnchor& anchor : anchors) ++begin_[pixel_of(anchor) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  constexpr float model = kSurfaceModelError;
  for (const SurfaceAnchor& anchor : anchors) {
    const float variance = anchor.relative_sigma * anchor.relative_sigma + model * model;
    const float value = std::log(anchor.inverse_depth);
    farthest_ = std::min(farthest_, value);
    points_[next[pixel_of(anchor)]++] = {anchor.x_px, anchor.y_px, value, 1 / variance};
  }
}

void PlaneLabels::spread(std::span<const SurfaceAnchor> anchors,
                         std::span<const InverseDepthPlane> planes) {
  constexpr int kNone = -1;
  Image<int> nearest(values_.width(), values_.height(), kNone);
  std::deque<std::size_t> front;
  const auto reach = [&](std::size_t i, int k) {
    if (nearest.pixels()[i] != kNone) return;
    nearest.pixels()[i] = k;
    front.push_back(i);
  };
  for (std::size_t k = 0; k < anchors.size(); ++k) reach(pixel_of(anchors[k]), static_cast<int>(k));
  while (!front.empty()) {
    const auto i = static_cast<int>(front.front());
    front.pop_front();
    const int x = i % values_.width(), y = i / values_.width();
    const int k = nearest(x, y);
    const auto anchor = static_cast<std::size_t>(k);
    PlaneValue& value = values_(x, y) = value_of(planes[anchor], x, y);
    value.cost += kDistanceCost * std::hypot(static_cast<float>(x) - anchors[anchor].x_px,
                                             static_cast<float>(y) - anchors[anchor].y_px);
    if (x > 0) reach(index(x - 1, y), k);
    if (x + 1 < values_.width()) reach(index(x + 1, y), k);
    if (y > 0) reach(index(x, y - 1), k);
    if (y + 1 < values_.height()) reach(index(x, y + 1), k);
  }
}

PlaneLabels::PlaneValue PlaneLabels::value_of(const InverseDepthPlane& plane, int x, int y) const {
  // Beyond twice the depth of the farthest point a plane continues at constant depth.
  const float least = std::exp(farthest_) / 2;
  const float here = plane.inverse_depth(static_cast<float>(x), static_cast<float>(y));
  PlaneValue value{std::log(std::max(here, least))};
  if (here > least) value.x = plane.x / here, value.y = plane.y / here;
  value.misfit = misfit_of(value, x, y);
  value.cost = value.misfit + kNearnessCost * (value.value - farthest_) +
               kSlopeCost * std::min(std::hypot(value.x, value.y), kSteepest);
  return value;
}

float PlaneLabels::misfit_of(const PlaneValue& value, int x, int y) const {
  const std::size_t begin = begin_[index(x, y)], end = begin_[index(x, y) + 1];
  if (begin == end) return 0;
  float sum = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const Point& point = points_[k];
    const float error = value.value + value.x * (point.x_px - static_cast<float>(x)) +
                        value.y * (point.y_px - static_cast<float>(y)) - point.value;
    sum += std::min(error * error * point.information / 2, error > 0 ? kHiddenCost : kOutlierCost);
  }
  return sum / static_cast<float>(end - begin);
}

float PlaneLabels::discontinuity_cost(const PlaneValue& a, const PlaneValue& b, int dx, int dy) {
  const auto x = static_cast<float>(dx), y = static_cast<float>(dy);
  const float change = std::abs(a.value - b.value + b.x * x + b.y * y) +
                       std::abs(a.value + a.x * x + a.y * y - b.value);
  return kDiscontinuityCost * std::min(1.F, change / (2 * kFullDiscontinuity));
}

void PlaneLabels::add_distance_cost(ExpansionMove& move) const {
  Image<PlaneValue>& offer = move.offer;
  cv::Mat is_far(offer.height(), offer.width(), CV_8U), distance;
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x) {
      const std::size_t i = index(move.left + x, move.top + y);
      const bool is_support = begin_[i + 1] > begin_[i] && offer(x, y).misfit < kSupport;
      is_far.at<std::uint8_t>(y, x) = is_support ? 0 : 1;
    }
  cv::distanceTransform(is_far, distance, cv::DIST_L2, cv::DIST_MASK_3);
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x)
      offer(x, y).cost += kDistanceCost * std::min(distance.at<float>(y, x), kFarthest_px);
}

void PlaneLabels::add_pairs(ExpansionMove& move) const {
  const Image<PlaneValue>& offer = move.offer;
  // Starting one row above and one column beside: pairs with one pixel outside, which stays fixed.
  for (int y = -1; y < offer.height(); ++y)
    for (int x = -1; x <= offer.width(); ++x)
      for (const Neighbour& n : kNeighbours) {
        const int u = x + n.dx, v = y + n.dy;
        const bool has_a = move.contains(x, y), has_b = move.contains(u, v);
        if (!has_a && !has_b) continue;
        if (!is_inside(values_, move.left + x, move.top + y) ||
            !is_inside(values_, move.left + u, move.top + v))
          continue;
        const PlaneValue& a = values_(move.left + x, move.top + y);
        const PlaneValue& b = values_(move.left + u, move.top + v);
        const float keep = n.length * discontinuity_cost(a, b, n.dx, n.dy);
        const float first = has_a ? n.length * discontinuity_cost(offer(x, y), b, n.dx, n.dy) : 0;
        const float second = has_b ? n.length * discontinuity_cost(a, offer(u, v), n.dx, n.dy) : 0;
        if (has_a && has_b) {
          move.add_pair(move.node(x, y), move.node(u, v), keep, second, first);
          continue;
        }
        const std::size_t i = has_a ? move.node(x, y) : move.node(u, v);
        move.keep[i] += keep;
        move.take[i] += has_a ? first : second;
      }
}

PlaneLabels::ExpansionMove PlaneLabels::move_of(const InverseDepthPlane& plane, int left, int top,
                                                int right, int bottom) const {
  ExpansionMove move(left, top, right - left, bottom - top);
  for (int y = 0; y < move.offer.height(); ++y)
    for (int x = 0; x < move.offer.width(); ++x)
      move.offer(x, y) = value_of(plane, left + x, top + y);
  return move;
}

float PlaneLabels::gain_of(const ExpansionMove& move) const {
  float gain = 0;
  for (int y = 0; y < move.offer.height(); ++y)
    for (int x = 0; x < move.offer.width(); ++x)
      gain += std::max(0.F, values_(move.left + x, move.top + y).misfit - move.offer(x, y).misfit);
  return gain;
}

void PlaneLabels::apply(ExpansionMove& move) {
  const Image<PlaneValue>& offer = move.offer;
  add_distance_cost(move);
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x) {
      move.keep[move.node(x, y)] += values_(move.left + x, move.top + y).cost;
      move.take[move.node(x, y)] += offer(x, y).cost;
    }
  add_pairs(move);
  move.solve();
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x)
      if (move.takes(move.node(x, y))) values_(move.left + x, move.top + y) = offer(x, y);
}

void PlaneLabels::expand(const InverseDepthPlane& plane) {
  ExpansionMove move = move_of(plane, 0, 0, values_.width(), values_.height());
  apply(move);
}

void PlaneLabels::expand_near(const InverseDepthPlane& plane, int x, int y, int reach_px) {
  ExpansionMove move = move_of(plane, std::max(x - reach_px, 0), std::max(y - reach_px, 0),
                               std::min(x + reach_px + 1, values_.width()),
                               std::min(y + reach_px + 1, values_.height()));
  if (gain_of(move) >= kLeastGain) apply(move);
}

}  // namespace saccade
