#include "estimator/reconstruction/gradient/gradient_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace saccade {

void GradientState::update(float hx, float hy, float z, float noise) {
  const float ax = pxx * hx + pxy * hy;
  const float ay = pxy * hx + pyy * hy;
  const float s = hx * ax + hy * ay + noise;         // (6.9)
  const float wx = ax / s, wy = ay / s;              // (6.10)
  const float innovation = z - (hx * gx + hy * gy);  // (6.7)
  gx += wx * innovation;                             // (6.11)
  gy += wy * innovation;
  pxx -= wx * ax;  // (6.12)
  pxy -= wx * ay;
  pyy -= wy * ay;
}

float GradientState::least_variance() const {
  return (pxx + pyy) / 2 - std::hypot((pxx - pyy) / 2, pxy);
}

GradientFilter::GradientFilter(const ReferenceGrid& grid, std::span<const ObservationKind> kinds,
                               double prior_variance)
    : grid_(grid),
      kinds_(kinds),
      states_(static_cast<std::size_t>(grid.width()) * static_cast<std::size_t>(grid.height())) {
  for (GradientState& state : states_) state.pxx = state.pyy = static_cast<float>(prior_variance);
}

void GradientFilter::add(std::span<const IntensityObservation> observations) {
  for (const IntensityObservation& observation : observations) {
    if (observation.run() >= last_.size())
      last_.resize(observation.run() + 1, IntensityObservation{-1, -1, 0, 0});
    IntensityObservation& last = last_[observation.run()];
    if (last.x >= 0) measure(last, observation);
    last = observation;
  }
}

void GradientFilter::measure(const IntensityObservation& from, const IntensityObservation& to) {
  constexpr float kMinWeight = 0.01F;
  constexpr float kMinLength_px = 0.02F;
  const float hx = to.x - from.x;
  const float hy = to.y - from.y;
  const float length = std::hypot(hx, hy);
  const float pieces = std::max(1.0F, std::ceil(length));
  const ObservationKind& kind = kinds_[to.kind()];
  const float noise = kind.sigma * kind.sigma * std::max(length, kMinLength_px) / pieces;
  const float change =
      (to.log_intensity + kind.expected - from.log_intensity - kinds_[from.kind()].expected) /
      pieces;
  for (float i = 0.5F; i < pieces; ++i) {
    const GridPoint point = grid_.at(from.x + i / pieces * hx, from.y + i / pieces * hy);
    for (std::size_t k = 0; k < 4; ++k)
      if (point.weight[k] > kMinWeight)
        states_[static_cast<std::size_t>(point.index[k])].update(hx / pieces, hy / pieces, change,
                                                                 noise / point.weight[k]);
  }
}

}  // namespace saccade
