#include "simulator/sensor/signal/pixel_signal.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// Coordinates of an environment map go around; those of `view` are brought next to `near`.
void unwrap_next_to(const RaySample& near, RaySample& sample) {
  if (sample.triangle != kNothing || sample.surface.texture == nullptr) return;
  const double period = sample.surface.texture->width();
  sample.surface.x += period * std::round((near.surface.x - sample.surface.x) / period);
}

RadianceRange hull(RadianceRange a, const RadianceRange& b) {
  a.low = std::min(a.low, b.low);
  a.high = std::max(a.high, b.high);
  a.rate_low = -RadianceRange::kUnknown;
  a.rate_high = RadianceRange::kUnknown;
  return a;
}

}  // namespace

template <std::size_t kRays>
std::size_t PixelSignal<kRays>::changing_ray(const Sample& lo, const Sample& hi) const {
  std::size_t k = 0;
  while (k < kRays && lo.rays[k].triangle == hi.rays[k].triangle) ++k;
  return k;
}

template <std::size_t kRays>
RadianceRange PixelSignal<kRays>::range(const Sample& lo, const Sample& hi) const {
  RadianceRange sum{0, 0, 0, 0};
  for (std::size_t k = 0; k < kRays; ++k)
    sum.add(lo.rays[k].triangle == hi.rays[k].triangle
                ? tracer_.radiance_range(directions_[k], lo.rays[k], lo.t_s, hi.rays[k], hi.t_s)
                : range_across_change(k, lo, hi));
  sum.scale(1.0 / kRays);
  return sum;
}

/// Both triangles' range over the whole interval.
template <std::size_t kRays>
RadianceRange PixelSignal<kRays>::range_across_change(std::size_t ray, const Sample& lo,
                                                      const Sample& hi) const {
  const double length_s = hi.t_s - lo.t_s;
  if (length_s <= tolerance_s_) return {};
  const RaySample& from = lo.rays[ray];
  const RaySample& to = hi.rays[ray];
  if (!tracer_.is_covered(directions_[ray], {from.triangle, lo.t_s}, {to.triangle, hi.t_s},
                          0.1 * tolerance_s_))
    return {};
  // Their light is that of the end at which they are seen, but for its flicker.
  RaySample from_later = tracer_.sample_unlit(directions_[ray], from.triangle, hi.t_s);
  RaySample to_earlier = tracer_.sample_unlit(directions_[ray], to.triangle, lo.t_s);
  from_later.surface.irradiance = from.surface.irradiance;
  to_earlier.surface.irradiance = to.surface.irradiance;
  from_later.surface.lights = from.surface.lights;
  to_earlier.surface.lights = to.surface.lights;
  return hull(tracer_.radiance_range(directions_[ray], from, lo.t_s, from_later, hi.t_s),
              tracer_.radiance_range(directions_[ray], to_earlier, lo.t_s, to, hi.t_s));
}

template <std::size_t kRays>
RaySample PixelSignal<kRays>::between(std::size_t ray, const Sample& lo, const Sample& hi,
                                      double t_s) const {
  const RaySample& from = lo.rays[ray];
  const RaySample& to = hi.rays[ray];
  const double length_s = hi.t_s - lo.t_s;
  if (!tracer_.is_lit() && is_straight(from, to, length_s))
    return interpolate(from, to, length_s, (t_s - lo.t_s) / length_s);
  // Where the same lights light both ends, they light what is between.
  RaySample sample = from.surface.lights == to.surface.lights
                         ? tracer_.sample(directions_[ray], from.triangle, from.surface.lights, t_s)
                         : tracer_.sample(directions_[ray], from.triangle, t_s);
  unwrap_next_to(from, sample);
  return sample;
}

template <std::size_t kRays>
auto PixelSignal<kRays>::at(double t_s, const Sample& lo, const Sample& hi) const -> Sample {
  Sample sample;
  sample.t_s = t_s;
  const std::size_t changing = changing_ray(lo, hi);
  if (changing < kRays) tracer_.trace(directions_, t_s, sample.rays);
  for (std::size_t k = 0; k < kRays; ++k)
    if (changing == kRays || lo.rays[k].triangle == hi.rays[k].triangle)
      sample.rays[k] = between(k, lo, hi, t_s);
    else
      unwrap_next_to(lo.rays[k], sample.rays[k]);
  set_log_intensity(sample);
  return sample;
}

template <std::size_t kRays>
auto PixelSignal<kRays>::trace(double t_s) const -> Sample {
  Sample sample;
  sample.t_s = t_s;
  tracer_.trace(directions_, t_s, sample.rays);
  set_log_intensity(sample);
  return sample;
}

template <std::size_t kRays>
auto PixelSignal<kRays>::resample(double t_s, const Sample& lo, const Sample& hi) const -> Sample {
  if (changing_ray(lo, hi) < kRays) return trace(t_s);
  Sample sample;
  sample.t_s = t_s;
  for (std::size_t k = 0; k < kRays; ++k) {
    sample.rays[k] = tracer_.sample(directions_[k], lo.rays[k].triangle, t_s);
    unwrap_next_to(lo.rays[k], sample.rays[k]);
  }
  set_log_intensity(sample);
  return sample;
}

template <std::size_t kRays>
auto PixelSignal<kRays>::divide(const Sample& lo, const Sample& hi, int depth) const -> Sample {
  constexpr int kGuesses = 8;  // deeper than this, halves: what is there is not what was guessed
  const double length_s = hi.t_s - lo.t_s;
  const std::size_t changing = changing_ray(lo, hi);
  if (changing < kRays && depth < kGuesses) return divide_at_change(changing, lo, hi);
  double fraction = 0.5;
  for (std::size_t k = 0; k < kRays && fraction == 0.5 && changing == kRays; ++k)
    if (kRays == 1 || !radiance_range(lo.rays[k], hi.rays[k], length_s).is_monotone())
      fraction = tracer_.split_fraction(directions_[k], lo.rays[k], lo.t_s, hi.rays[k], hi.t_s);
  return at(lo.t_s + fraction * length_s, lo, hi);
}

/// Right before the change, or, where that has been sampled already, right after it: two samples
/// enclose it within the tolerance. Neighbours in a mesh need no ray.
template <std::size_t kRays>
auto PixelSignal<kRays>::divide_at_change(std::size_t ray, const Sample& lo, const Sample& hi) const
    -> Sample {
  const double middle_s = 0.5 * (lo.t_s + hi.t_s);
  const Eigen::Vector3d& direction = directions_[ray];
  const TriangleId from = lo.rays[ray].triangle;
  const TriangleId to = hi.rays[ray].triangle;
  const double change_s =
      tracer_.change_s(direction, {from, lo.t_s}, {to, hi.t_s}, 0.1 * tolerance_s_);
  if (std::isnan(change_s)) return at(middle_s, lo, hi);
  const bool is_before = change_s - 0.6 * tolerance_s_ > lo.t_s;
  const double t_s = is_before ? change_s - 0.4 * tolerance_s_ : change_s + 0.4 * tolerance_s_;
  if (!(t_s < hi.t_s)) return at(middle_s, lo, hi);
  if (kRays > 1 || !tracer_.is_crease(direction, from, to, change_s)) return at(t_s, lo, hi);
  Sample sample;
  sample.t_s = t_s;
  sample.rays[ray] = tracer_.sample(direction, is_before ? from : to, t_s);
  set_log_intensity(sample);
  return sample;
}

template class PixelSignal<1>;
template class PixelSignal<4>;
template class PixelSignal<16>;

}  // namespace saccade
