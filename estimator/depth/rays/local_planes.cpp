#include "estimator/depth/rays/local_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/LU>

#include "estimator/depth/rays/biweight.h"
#include "estimator/lanes.h"

namespace saccade {
namespace {

constexpr float kMaxSlope = 0.02F;    ///< relative change of inverse depth per pixel at the start
constexpr float kOnPlane = 0.02F;     ///< relative distance of points that belong to a plane
constexpr float kSlopePrior = 0.01F;  ///< sigma of the relative slope [1/px]
// Sum of weights from which on a plane is known better by its nearest points than by more of them.
constexpr float kEnoughWeights = 20;
constexpr float kWidening = 10.F / 7;  ///< of the radius: twice the area
constexpr int kIterations = 4;         ///< of reweighting; the weights have settled by then
// surface_side(): a surface behind lies farther by kBehind, relatively, within kBehindRadiusRatio
// radii, with kMinBehindPoints points or more, since one may be wrong.
constexpr float kBehind = 0.05F;
constexpr float kBehindRadiusRatio = 3;
constexpr float kMinBehindPoints = 2;
constexpr float kMinBehindRatio = 3;      ///< to the points behind on the other side
constexpr float kMinSideDistance_px = 1;  ///< points nearer to the edge are on neither side
constexpr float kContinuesRatio = 0.25F;  ///< weight beyond the edge of a surface that continues

}  // namespace

LocalPlanes::LocalPlanes(const std::vector<EdgePoint>& points, const PlaneOptions& options)
    : options_(options) {
  const auto cell_px = static_cast<float>(options.radius_px);
  for (const EdgePoint& point : points) {
    columns_ = std::max(columns_, static_cast<int>(point.x_px / cell_px) + 1);
    rows_ = std::max(rows_, static_cast<int>(point.y_px / cell_px) + 1);
  }
  const auto index = [&](const EdgePoint& point) {
    return static_cast<std::size_t>(cell_of(point.y_px, rows_)) *
               static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(cell_of(point.x_px, columns_));
  };
  begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const EdgePoint& point : points) ++begin_[index(point) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  points_.resize(points.size());
  for (const EdgePoint& point : points) points_[next[index(point)]++] = point;
}

int LocalPlanes::cell_of(float px, int cells) const {
  const int cell = static_cast<int>(std::floor(px / static_cast<float>(options_.radius_px)));
  return std::clamp(cell, 0, std::max(cells - 1, 0));
}

template <class Visit>
void LocalPlanes::for_near(float x_px, float y_px, float radius, const Visit& visit) const {
  if (points_.empty()) return;
  const auto left = static_cast<std::size_t>(cell_of(x_px - radius, columns_));
  const auto right = static_cast<std::size_t>(cell_of(x_px + radius, columns_));
  const auto bottom = static_cast<std::size_t>(cell_of(y_px + radius, rows_));
  for (auto row = static_cast<std::size_t>(cell_of(y_px - radius, rows_)); row <= bottom; ++row) {
    const std::size_t cells = row * static_cast<std::size_t>(columns_);
    for (std::size_t i = begin_[cells + left]; i < begin_[cells + right + 1]; ++i) {
      const float dx = points_[i].x_px - x_px, dy = points_[i].y_px - y_px;
      const float squared = dx * dx + dy * dy;
      if (squared <= radius * radius) visit(points_[i], dx, dy, squared);
    }
  }
}

const EdgePoint* LocalPlanes::nearest(float x_px, float y_px) const {
  const EdgePoint* best = nullptr;
  float least = 0;
  for_near(x_px, y_px, static_cast<float>(options_.radius_px),
           [&](const EdgePoint& point, float, float, float squared) {
             if (best != nullptr && squared >= least) return;
             best = &point;
             least = squared;
           });
  return best;
}

void LocalPlanes::gather(const EdgePoint& start, float radius_px) {
  const float model = static_cast<float>(options_.model_error) * start.inverse_depth;
  dx_.clear(), dy_.clear(), difference_.clear(), per_sigma_.clear();
  for_near(start.x_px, start.y_px, radius_px,
           [&](const EdgePoint& other, float dx, float dy, float squared) {
             const float difference = other.inverse_depth - start.inverse_depth;
             const float allowed =
                 kMaxSlope * std::sqrt(squared) * start.inverse_depth +
                 3 * std::sqrt(start.sigma * start.sigma + other.sigma * other.sigma);
             if (std::abs(difference) > allowed) return;
             dx_.push_back(dx);
             dy_.push_back(dy);
             difference_.push_back(difference);
             per_sigma_.push_back(1 / std::sqrt(other.sigma * other.sigma + model * model));
           });
  count_ = dx_.size();
  start_inverse_depth_ = start.inverse_depth;
  for (auto* array : {&dx_, &dy_, &difference_, &per_sigma_})
    array->resize(padded_to_lanes(count_), 0.F);
}

float LocalPlanes::spread_around_start() {
  scratch_.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) scratch_[i] = std::abs(difference_[i]) * per_sigma_[i];
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  return std::max(1.F, 1.4826F * *middle);
}

LocalPlanes::Sums LocalPlanes::weighted_sums(const Eigen::Vector3f& plane, float spread) const {
  const float per_cut = 1 / (kBiweightCutoff * spread);
  Lanes weights{}, rr{}, one{}, x{}, y{}, xx{}, xy{}, yy{}, d{}, dx{}, dy{};
  for (std::size_t k = 0; k < dx_.size(); k += kLanes) {
    const Lanes px = load_lanes(&dx_[k]), py = load_lanes(&dy_[k]),
                delta = load_lanes(&difference_[k]);
    const Lanes per_sigma = load_lanes(&per_sigma_[k]);
    const Lanes r = (delta - plane.x() - plane.y() * px - plane.z() * py) * per_sigma;
    const Lanes u = r * per_cut;
    Lanes v = 1 - u * u;
    v = v > 0 ? v : Lanes{};
    const Lanes used = per_sigma > 0 ? Lanes{} + 1 : Lanes{};
    const Lanes w = v * v * used;
    const Lanes information = w * per_sigma * per_sigma;
    const Lanes ix = information * px, iy = information * py;
    weights += w, rr += w * r * r;
    one += information, x += ix, y += iy, xx += ix * px, xy += ix * py, yy += iy * py;
    d += information * delta, dx += ix * delta, dy += iy * delta;
  }
  Sums sums;
  sums.weights = static_cast<float>(total(weights));
  sums.squares = static_cast<float>(total(rr));
  sums.normal << total(one), total(x), total(y),  //
      total(x), total(xx), total(xy),             //
      total(y), total(xy), total(yy);
  sums.right = {total(d), total(dx), total(dy)};
  return sums;
}

LocalPlane LocalPlanes::fit(const EdgePoint& start) {
  return fit_within(static_cast<float>(options_.radius_px), start);
}

LocalPlane LocalPlanes::fit_widened(const EdgePoint& start) {
  LocalPlane plane = fit(start);
  const auto widened_px = kWidening * static_cast<float>(options_.radius_px);
  const auto is_alone = [&] {
    return std::isinf(gap_within(widened_px, start.x_px, start.y_px, plane));
  };
  if (plane.weights < kEnoughWeights && is_alone()) plane = fit_within(widened_px, start);
  return plane;
}

LocalPlane LocalPlanes::fit_within(float radius_px, const EdgePoint& start) {
  gather(start, radius_px);
  LocalPlane result;
  result.inverse_depth = start.inverse_depth;
  result.sigma = start.sigma;
  if (count_ == 0) return result;
  result.spread = spread_around_start();
  const double slope_information =
      1 / std::pow(static_cast<double>(kSlopePrior * start.inverse_depth), 2);
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  float squares = 0;
  for (int i = 0; i < kIterations; ++i) {
    if (i > 0)
      result.spread = std::max(
          1.F, std::sqrt(static_cast<float>(kBiweightVariance) * squares / result.weights));
    Sums sums = weighted_sums(plane, result.spread);
    result.weights = sums.weights;
    squares = sums.squares;
    if (!(result.weights > 0)) return result;
    sums.normal(1, 1) += slope_information;
    sums.normal(2, 2) += slope_information;
    const Eigen::Matrix3d inverse = sums.normal.inverse();
    plane = (inverse * sums.right).cast<float>();
    result.sigma = static_cast<float>(std::sqrt(inverse(0, 0)));
  }
  result.inverse_depth = start.inverse_depth + plane.x();
  result.slope = plane.tail<2>();
  return result;
}

float LocalPlanes::weight_of(std::size_t neighbour, const LocalPlane& plane) const {
  const float change = plane.inverse_depth - start_inverse_depth_;
  const float per_cut = 1 / (kBiweightCutoff * plane.spread);
  const float residual = difference_[neighbour] - change - plane.slope.x() * dx_[neighbour] -
                         plane.slope.y() * dy_[neighbour];
  const float u = residual * per_sigma_[neighbour] * per_cut;
  const float v = std::max(0.F, 1 - u * u);
  return v * v;
}

bool LocalPlanes::surrounds_start(const LocalPlane& plane) const {
  std::array<bool, 4> has_point{};
  for (std::size_t k = 0; k < count_; ++k)
    if (weight_of(k, plane) > 0) has_point[(dx_[k] > 0 ? 1U : 0U) + (dy_[k] > 0 ? 2U : 0U)] = true;
  return std::ranges::all_of(has_point, std::identity());
}

LocalPlanes::Sides LocalPlanes::plane_sides(const LocalPlane& plane,
                                            const Eigen::Vector2f& normal) const {
  Sides sides;
  for (std::size_t k = 0; k < count_; ++k) {
    const float across = dx_[k] * normal.x() + dy_[k] * normal.y();
    if (std::abs(across) < kMinSideDistance_px) continue;
    (across > 0 ? sides.along : sides.against) += weight_of(k, plane);
  }
  return sides;
}

LocalPlanes::Sides LocalPlanes::behind_sides(const EdgePoint& start,
                                             const LocalPlane& plane) const {
  Sides sides;
  const float radius = kBehindRadiusRatio * static_cast<float>(options_.radius_px);
  for_near(start.x_px, start.y_px, radius, [&](const EdgePoint& other, float dx, float dy, float) {
    const float expected = plane.inverse_depth + plane.slope.x() * dx + plane.slope.y() * dy;
    if (other.inverse_depth > (1 - kBehind) * expected) return;
    const float across = dx * start.normal.x() + dy * start.normal.y();
    (across > 0 ? sides.along : sides.against) += 1;
  });
  return sides;
}

int LocalPlanes::surface_side(const EdgePoint& start, const LocalPlane& plane) const {
  const Sides own = plane_sides(plane, start.normal);
  const bool is_along = own.along > own.against;
  const float more = is_along ? own.along : own.against;
  if (more > 0 && (is_along ? own.against : own.along) > kContinuesRatio * more) return 0;
  const Sides behind = behind_sides(start, plane);
  const auto is_mostly = [](float here, float there) {
    return here >= kMinBehindPoints && here > kMinBehindRatio * there;
  };
  if (more > 0) {
    if ((is_along ? behind.against : behind.along) < kMinBehindPoints) return 0;
    return is_along ? 1 : -1;
  }
  // A contour without other points of its surface.
  if (is_mostly(behind.along, behind.against)) return -1;
  return is_mostly(behind.against, behind.along) ? 1 : 0;
}

float LocalPlanes::gap_within(float radius_px, float x_px, float y_px,
                              const LocalPlane& plane) const {
  float nearest = std::numeric_limits<float>::infinity(), second = nearest;
  const float always = kOnPlane * plane.inverse_depth;
  for_near(x_px, y_px, radius_px, [&](const EdgePoint& other, float dx, float dy, float) {
    const float gap = std::abs(other.inverse_depth - plane.inverse_depth - plane.slope.x() * dx -
                               plane.slope.y() * dy);
    if (gap < always + kBiweightCutoff * plane.spread * other.sigma || gap >= second) return;
    second = gap >= nearest ? gap : nearest;
    nearest = std::min(nearest, gap);
  });
  return second;
}

}  // namespace saccade
