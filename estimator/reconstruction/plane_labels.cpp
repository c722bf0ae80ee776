#include "estimator/reconstruction/plane_labels.h"

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

constexpr float kLeastGain = 1;      ///< of points, for which a plane is worth a try
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

/// Which pixels of a rectangle take a plane: a minimum cut. What is on the source's side keeps its
/// own, what is on the sink's side takes the new one.
struct PlaneLabels::Moves {
  Moves(int first_x, int first_y, int width, int height)
      : left(first_x),
        top(first_y),
        offer(width, height),
        keep(offer.size(), 0.F),
        take(offer.size(), 0.F),
        graph(static_cast<unsigned>(offer.size()),
              static_cast<unsigned>(2 * kNeighbours.size() * offer.size())) {
    for (std::size_t i = 0; i < offer.size(); ++i) graph.addVtx();
  }

  [[nodiscard]] bool holds(int x, int y) const {
    return x >= 0 && y >= 0 && x < offer.width() && y < offer.height();
  }
  [[nodiscard]] std::size_t node(int x, int y) const {
    return static_cast<std::size_t>(y * offer.width() + x);
  }

  /// What a pair costs that keeps both, of which the second takes, of which the first does; if both
  /// take, nothing.
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
    if (has_edges) graph.maxFlow();  // which a graph without edges does not have
  }

  /// Whether a pixel takes the offer, after solve().
  [[nodiscard]] bool takes(std::size_t i) const {
    return has_edges ? !graph.inSourceSegment(static_cast<int>(i)) : take[i] < keep[i];
  }

  int left, top;
  Image<Sheet> offer;  ///< the plane at the pixels of the rectangle
  std::vector<float> keep, take;
  mutable cv::detail::GCGraph<float> graph;  ///< its queries are not const
  bool has_edges = false;
};

PlaneLabels::PlaneLabels(int width, int height, std::span<const SurfaceAnchor> anchors,
                         std::span<const ImagePlane> planes, const PlaneLabelOptions& options)
    : options_(options), farthest_(std::numeric_limits<float>::infinity()), sheets_(width, height) {
  SACCADE_CHECK(!anchors.empty() && anchors.size() == planes.size());
  sort_by_pixel(anchors);
  spread(anchors, planes);
}

std::size_t PlaneLabels::pixel_of(const SurfaceAnchor& anchor) const {
  return index(std::clamp(static_cast<int>(std::lround(anchor.x_px)), 0, sheets_.width() - 1),
               std::clamp(static_cast<int>(std::lround(anchor.y_px)), 0, sheets_.height() - 1));
}

void PlaneLabels::sort_by_pixel(std::span<const SurfaceAnchor> anchors) {
  points_.resize(anchors.size());
  begin_.assign(sheets_.size() + 1, 0);
  for (const SurfaceAnchor& anchor : anchors) ++begin_[pixel_of(anchor) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  const auto model = static_cast<float>(options_.model_error);
  for (const SurfaceAnchor& anchor : anchors) {
    const float variance = anchor.relative_sigma * anchor.relative_sigma + model * model;
    const float value = std::log(anchor.inverse_depth);
    farthest_ = std::min(farthest_, value);
    points_[next[pixel_of(anchor)]++] = {anchor.x_px, anchor.y_px, value, 1 / variance};
  }
}

void PlaneLabels::spread(std::span<const SurfaceAnchor> anchors,
                         std::span<const ImagePlane> planes) {
  constexpr int kNone = -1;
  Image<int> nearest(sheets_.width(), sheets_.height(), kNone);
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
    const int x = i % sheets_.width(), y = i / sheets_.width();
    const int k = nearest(x, y);
    const auto anchor = static_cast<std::size_t>(k);
    Sheet& sheet = sheets_(x, y) = sheet_of(planes[anchor], x, y);
    sheet.cost += static_cast<float>(options_.reach_cost) *
                  std::hypot(static_cast<float>(x) - anchors[anchor].x_px,
                             static_cast<float>(y) - anchors[anchor].y_px);
    if (x > 0) reach(index(x - 1, y), k);
    if (x + 1 < sheets_.width()) reach(index(x + 1, y), k);
    if (y > 0) reach(index(x, y - 1), k);
    if (y + 1 < sheets_.height()) reach(index(x, y + 1), k);
  }
}

PlaneLabels::Sheet PlaneLabels::sheet_of(const ImagePlane& plane, int x, int y) const {
  // Twice as far as the farthest point a plane goes on at the same depth.
  const float least = std::exp(farthest_) / 2;
  const float here = plane.inverse_depth(static_cast<float>(x), static_cast<float>(y));
  Sheet sheet{std::log(std::max(here, least))};
  if (here > least) sheet.x = plane.x / here, sheet.y = plane.y / here;
  sheet.misfit = misfit_of(sheet, x, y);
  sheet.cost = sheet.misfit +
               static_cast<float>(options_.nearness_cost) * (sheet.value - farthest_) +
               static_cast<float>(options_.steepness_cost) *
                   std::min(std::hypot(sheet.x, sheet.y), kSteepest);
  return sheet;
}

float PlaneLabels::misfit_of(const Sheet& sheet, int x, int y) const {
  const std::size_t begin = begin_[index(x, y)], end = begin_[index(x, y) + 1];
  if (begin == end) return 0;
  float sum = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const Point& point = points_[k];
    const float error = sheet.value + sheet.x * (point.x_px - static_cast<float>(x)) +
                        sheet.y * (point.y_px - static_cast<float>(y)) - point.value;
    sum += std::min(error * error * point.information / 2,
                    static_cast<float>(error > 0 ? options_.hidden_cost : options_.outlier_cost));
  }
  return sum / static_cast<float>(end - begin);
}

float PlaneLabels::step_cost(const Sheet& a, const Sheet& b, int dx, int dy) const {
  const auto x = static_cast<float>(dx), y = static_cast<float>(dy);
  const float change = std::abs(a.value - b.value + b.x * x + b.y * y) +
                       std::abs(a.value + a.x * x + a.y * y - b.value);
  return static_cast<float>(options_.step_cost) *
         std::min(1.F, change / (2 * static_cast<float>(options_.full_step)));
}

void PlaneLabels::add_reach(Moves& moves) const {
  Image<Sheet>& offer = moves.offer;
  cv::Mat is_far(offer.height(), offer.width(), CV_8U), distance;
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x) {
      const std::size_t i = index(moves.left + x, moves.top + y);
      const bool is_support = begin_[i + 1] > begin_[i] && offer(x, y).misfit < kSupport;
      is_far.at<std::uint8_t>(y, x) = is_support ? 0 : 1;
    }
  cv::distanceTransform(is_far, distance, cv::DIST_L2, cv::DIST_MASK_3);
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x)
      offer(x, y).cost += static_cast<float>(options_.reach_cost) *
                          std::min(distance.at<float>(y, x), kFarthest_px);
}

void PlaneLabels::add_pairs(Moves& moves) const {
  const Image<Sheet>& offer = moves.offer;
  // From one row above and one column beside: pairs with one pixel outside, which stays as it is.
  for (int y = -1; y < offer.height(); ++y)
    for (int x = -1; x <= offer.width(); ++x)
      for (const Neighbour& n : kNeighbours) {
        const int u = x + n.dx, v = y + n.dy;
        const bool has_a = moves.holds(x, y), has_b = moves.holds(u, v);
        if (!has_a && !has_b) continue;
        if (!is_inside(sheets_, moves.left + x, moves.top + y) ||
            !is_inside(sheets_, moves.left + u, moves.top + v))
          continue;
        const Sheet& a = sheets_(moves.left + x, moves.top + y);
        const Sheet& b = sheets_(moves.left + u, moves.top + v);
        const float keep = n.length * step_cost(a, b, n.dx, n.dy);
        const float first = has_a ? n.length * step_cost(offer(x, y), b, n.dx, n.dy) : 0;
        const float second = has_b ? n.length * step_cost(a, offer(u, v), n.dx, n.dy) : 0;
        if (has_a && has_b) {
          moves.add_pair(moves.node(x, y), moves.node(u, v), keep, second, first);
          continue;
        }
        const std::size_t i = has_a ? moves.node(x, y) : moves.node(u, v);
        moves.keep[i] += keep;
        moves.take[i] += has_a ? first : second;
      }
}

PlaneLabels::Moves PlaneLabels::moves_of(const ImagePlane& plane, int left, int top, int right,
                                         int bottom) const {
  Moves moves(left, top, right - left, bottom - top);
  for (int y = 0; y < moves.offer.height(); ++y)
    for (int x = 0; x < moves.offer.width(); ++x)
      moves.offer(x, y) = sheet_of(plane, left + x, top + y);
  return moves;
}

float PlaneLabels::gain_of(const Moves& moves) const {
  float gain = 0;
  for (int y = 0; y < moves.offer.height(); ++y)
    for (int x = 0; x < moves.offer.width(); ++x)
      gain +=
          std::max(0.F, sheets_(moves.left + x, moves.top + y).misfit - moves.offer(x, y).misfit);
  return gain;
}

void PlaneLabels::make(Moves& moves) {
  const Image<Sheet>& offer = moves.offer;
  add_reach(moves);
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x) {
      moves.keep[moves.node(x, y)] += sheets_(moves.left + x, moves.top + y).cost;
      moves.take[moves.node(x, y)] += offer(x, y).cost;
    }
  add_pairs(moves);
  moves.solve();
  for (int y = 0; y < offer.height(); ++y)
    for (int x = 0; x < offer.width(); ++x)
      if (moves.takes(moves.node(x, y))) sheets_(moves.left + x, moves.top + y) = offer(x, y);
}

void PlaneLabels::expand(const ImagePlane& plane) {
  Moves moves = moves_of(plane, 0, 0, sheets_.width(), sheets_.height());
  make(moves);
}

void PlaneLabels::expand_near(const ImagePlane& plane, int x, int y, int reach_px) {
  Moves moves = moves_of(plane, std::max(x - reach_px, 0), std::max(y - reach_px, 0),
                         std::min(x + reach_px + 1, sheets_.width()),
                         std::min(y + reach_px + 1, sheets_.height()));
  if (gain_of(moves) >= kLeastGain) make(moves);
}

}  // namespace saccade
