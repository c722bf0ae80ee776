#include "simulator/sensor/signal/ray_sample.h"

#include <algorithm>
#include <cmath>

#include "simulator/sensor/signal/mipmap_bounds.h"
#include "simulator/sensor/signal/cell_bounds.h"

namespace saccade {
namespace {

/// Multiplies the albedo's range by the light. Under the same lamps the irradiance is taken to stay
/// near the line between both ends; where they differ, it jumps at the edge of a shadow.
RadianceRange illuminated(const Interval& values, const Interval& rates, const RayView& from,
                          const RayView& to, double length_s) {
  const double factor = from.look.texture != nullptr ? from.look.factor : 1;
  const double a = factor * from.look.irradiance;
  const double b = factor * to.look.irradiance;
  if (a == b) return {a * values.low, a * values.high, a * rates.low, a * rates.high};
  if (from.look.lamps != to.look.lamps) {
    const Interval radiance = product(values, {std::min(a, b), std::max(a, b)});
    return {radiance.low, radiance.high, -RadianceRange::kUnknown, RadianceRange::kUnknown};
  }
  const double slack = 0.25 * std::abs(b - a);
  const Interval light{std::min(a, b) - slack, std::max(a, b) + slack};
  const Interval light_rate{(b - a - 2 * slack) / length_s, (b - a + 2 * slack) / length_s};
  const Interval radiance = product(values, light);
  const Interval first = product(rates, light);
  const Interval second = product(values, light_rate);
  return {radiance.low, radiance.high, first.low + second.low, first.high + second.high};
}

}  // namespace

double log_intensity(double radiance, double log_eps) { return std::log(log_eps + radiance); }

double RadianceRange::log_error(double log_eps, double length_s) const {
  const double least = log_eps + std::max(low, 0.0);
  const double most = log_eps + high;
  const double spread = most / least - 1;  // at least its logarithm, and as good where it is small
  const double fastest = rate_high / (rate_high > 0 ? least : most);
  const double slowest = rate_low / (rate_low > 0 ? most : least);
  const double straying = 0.25 * (fastest - slowest) * length_s;
  return straying < spread ? straying : spread;  // also when one is not a number
}

RadianceRange radiance_range(const RayView& from, const RayView& to, double length_s) {
  if (from.look.texture != to.look.texture) return {};
  const Track x = x_track(from, to, length_s);
  if (from.look.texture == nullptr) return illuminated(x.values(), x.rates(), from, to, length_s);
  const Interval across = x.values();
  const Interval down = y_track(from, to, length_s).values();
  if (!(across.high - across.low < 1e6 && down.high - down.low < 1e6)) return {};
  const PathRange range =
      is_filtered(from, to) ? pyramid_range(from, to, length_s) : picture_range(from, to, length_s);
  return illuminated(range.values, range.rates, from, to, length_s);
}

RayView interpolate(const RayView& from, const RayView& to, double length_s, double fraction) {
  const Track x = x_track(from, to, length_s);
  const Track y = y_track(from, to, length_s);
  RayView view = from;
  view.look.x = x.at(fraction);
  view.look.y = y.at(fraction);
  view.x_rate = x.rate_at(fraction);
  view.y_rate = y.rate_at(fraction);
  if (is_filtered(from, to)) {
    const Track level = level_track(from, to, length_s);
    view.look.level = std::max(level.at(fraction), 0.0);
    view.level_rate = level.rate_at(fraction);
  }
  view.look.distance += fraction * (to.look.distance - from.look.distance);
  view.look.irradiance += fraction * (to.look.irradiance - from.look.irradiance);
  return view;
}

bool is_straight(const RayView& from, const RayView& to, double length_s) {
  constexpr double kLevelStraight = 1e-5;  // of kinks the cubic knows nothing
  if (is_filtered(from, to) && level_track(from, to, length_s).stray() > kLevelStraight)
    return false;
  return x_track(from, to, length_s).stray() + y_track(from, to, length_s).stray() <
         kStraight_texel;
}

double dividing_fraction(const RayView& from, const RayView& to, double length_s) {
  if (from.look.texture == nullptr || from.look.texture != to.look.texture ||
      from.look.lamps != to.look.lamps)
    return 0.5;
  if (is_filtered(from, to)) return pyramid_dividing_fraction(from, to, length_s);
  const Track x = x_track(from, to, length_s);
  const Track y = y_track(from, to, length_s);
  Division division;
  division.consider_cell(x, y);
  if (division.found()) return division.fraction();
  return extremum_in_cell(*from.look.texture, x, y);
}

}  // namespace saccade
