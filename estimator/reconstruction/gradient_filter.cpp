#include "estimator/reconstruction/gradient_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace saccade {

void GradientState::update(float hx, float hy, float z, float noise) {
  const float ax = pxx * hx + pxy * hy;
  const float ay = pxy * hx + pyy * hy;
  const float s = hx * ax + hy * ay + noise;
  const float wx = ax / s;
  const float wy = ay / s;
  const float innovation = z - (hx * gx + hy * gy);
  gx += wx * innovation;
  gy += wy * innovation;
  pxx -= wx * ax;
  pxy -= wx * ay;
  pyy -= wy * ay;
}

float GradientState::least_variance() const {
  return (pxx + pyy) / 2 - std::hypot((pxx - pyy) / 2, pxy);
}

GradientFilter::GradientFilter(const ReferenceGrid& grid, std::span<const LevelSort> sorts,
                               double prior_variance)
    : grid_(grid),
      sorts_(sorts.begin(), sorts.end()),
      states_(static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height())) {
  for (GradientState& state : states_) state.pxx = state.pyy = static_cast<float>(prior_variance);
}

void GradientFilter::add(std::span<const PlaceLevel> levels) {
  for (const PlaceLevel& level : levels) {
    if (level.track() >= last_.size()) last_.resize(level.track() + 1, PlaceLevel{-1, -1, 0, 0});
    PlaceLevel& last = last_[level.track()];
    if (last.x >= 0) measure(last, level);
    last = level;
  }
}

void GradientFilter::measure(const PlaceLevel& from, const PlaceLevel& to) {
  constexpr float kLeastWeight = 0.01F;
  constexpr float kShortest = 0.02F;  // [px]
  const float hx = to.x - from.x;
  const float hy = to.y - from.y;
  const float length = std::hypot(hx, hy);
  const float pieces = std::max(1.0F, std::ceil(length));
  const LevelSort& sort = sorts_[to.sort()];
  const float noise = sort.deviation * sort.deviation * std::max(length, kShortest) / pieces;
  const float change = (to.level + sort.beyond - from.level - sorts_[from.sort()].beyond) / pieces;
  for (float i = 0.5F; i < pieces; ++i) {
    const GridPoint point = grid_.at(from.x + i / pieces * hx, from.y + i / pieces * hy);
    for (std::size_t k = 0; k < 4; ++k)
      if (point.weight[k] > kLeastWeight)
        states_[static_cast<std::size_t>(point.index[k])].update(hx / pieces, hy / pieces, change,
                                                                 noise / point.weight[k]);
  }
}

}  // namespace saccade
