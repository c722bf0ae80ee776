#include "simulator/sensor/signal/ray_sample.h"

#include <cmath>

#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/signal/mipmap_bounds.h"

namespace saccade {
namespace {

/// Multiplies the albedo's range by a flickering light whose range is known.
RadianceRange illuminated(const Interval& values, const Interval& rates, const RaySample& from,
                          const RaySample& to, const LightRange& light) {
  const double factor = from.surface.texture != nullptr ? from.surface.factor : 1;
  const Interval radiance = product(values, {factor * light.low, factor * light.high});
  const bool is_known = std::isfinite(light.rate_low) && std::isfinite(light.rate_high) &&
                        from.surface.lights == to.surface.lights;
  if (!is_known)
    return {radiance.low, radiance.high, -RadianceRange::kUnknown, RadianceRange::kUnknown};
  const Interval first = product(rates, {factor * light.low, factor * light.high});
  const Interval second = product(values, {factor * light.rate_low, factor * light.rate_high});
  return {radiance.low, radiance.high, first.low + second.low, first.high + second.high};
}

/// Multiplies the albedo's range by the light. Under the same lights the irradiance is taken to
/// stay near the line between both ends; where they differ, it jumps at the edge of a shadow.
RadianceRange illuminated(const Interval& values, const Interval& rates, const RaySample& from,
                          const RaySample& to, double length_s, const LightRange* flickering) {
  if (flickering != nullptr) return illuminated(values, rates, from, to, *flickering);
  const double factor = from.surface.texture != nullptr ? from.surface.factor : 1;
  const double a = factor * from.surface.irradiance;
  const double b = factor * to.surface.irradiance;
  if (a == b) return {a * values.low, a * values.high, a * rates.low, a * rates.high};
  if (from.surface.lights != to.surface.lights) {
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

RadianceRange radiance_range(const RaySample& from, const RaySample& to, double length_s,
                             const LightRange* light) {
  if (from.surface.texture != to.surface.texture) return {};
  const HermiteCoordinate x = x_coordinate(from, to, length_s);
  if (from.surface.texture == nullptr)
    return illuminated(x.values(), x.rates(), from, to, length_s, light);
  const Interval across = x.values();
  const Interval down = y_coordinate(from, to, length_s).values();
  if (!(across.high - across.low < 1e6 && down.high - down.low < 1e6)) return {};
  const TextureRange range =
      is_filtered(from, to) ? mipmap_range(from, to, length_s) : texture_range(from, to, length_s);
  return illuminated(range.values, range.rates, from, to, length_s, light);
}

RaySample interpolate(const RaySample& from, const RaySample& to, double length_s,
                      double fraction) {
  const HermiteCoordinate x = x_coordinate(from, to, length_s);
  const HermiteCoordinate y = y_coordinate(from, to, length_s);
  RaySample sample = from;
  sample.surface.x = x.at(fraction);
  sample.surface.y = y.at(fraction);
  sample.x_rate = x.rate_at(fraction);
  sample.y_rate = y.rate_at(fraction);
  if (is_filtered(from, to)) {
    const HermiteCoordinate level = level_coordinate(from, to, length_s);
    sample.surface.level = std::max(level.at(fraction), 0.0);
    sample.level_rate = level.rate_at(fraction);
  }
  sample.surface.distance += fraction * (to.surface.distance - from.surface.distance);
  sample.surface.irradiance += fraction * (to.surface.irradiance - from.surface.irradiance);
  return sample;
}

bool is_straight(const RaySample& from, const RaySample& to, double length_s) {
  constexpr double kLevelStraight = 1e-5;  // of kinks the cubic knows nothing
  if (is_filtered(from, to) && level_coordinate(from, to, length_s).chord_error() > kLevelStraight)
    return false;
  return x_coordinate(from, to, length_s).chord_error() +
             y_coordinate(from, to, length_s).chord_error() <
         kStraight_texel;
}

double split_fraction(const RaySample& from, const RaySample& to, double length_s) {
  if (from.surface.texture == nullptr || from.surface.texture != to.surface.texture ||
      from.surface.lights != to.surface.lights)
    return 0.5;
  if (is_filtered(from, to)) return mipmap_split_fraction(from, to, length_s);
  const HermiteCoordinate x = x_coordinate(from, to, length_s);
  const HermiteCoordinate y = y_coordinate(from, to, length_s);
  SplitPoint division;
  division.consider_cell(x, y);
  if (division.found()) return division.fraction();
  return extremum_in_cell(*from.surface.texture, x, y);
}

}  // namespace saccade
