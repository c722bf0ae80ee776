#include "simulator/sensor/signal/mipmap_bounds.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

double coarsest(const Texture& texture) { return static_cast<double>(texture.level_count() - 1); }

/// The finer of the two levels that the middle of the path lies between.
double middle_level(const Texture& texture, const HermiteCoordinate& level) {
  const double middle = std::floor(0.5 * (level.from + level.to));
  return std::clamp(middle, 0.0, std::max(coarsest(texture) - 1, 0.0));
}

/// The view in the picture of level `k` alone.
RaySample on_level(const RaySample& sample, double k) {
  const Texture& texture = *sample.surface.texture;
  const Texture& picture = texture.level(static_cast<std::size_t>(k));
  const double x_scale = static_cast<double>(picture.width()) / texture.width();
  const double y_scale = static_cast<double>(picture.height()) / texture.height();
  RaySample result = sample;
  result.surface.texture = &picture;
  result.surface.x = (sample.surface.x + 0.5) * x_scale - 0.5;
  result.surface.y = (sample.surface.y + 0.5) * y_scale - 0.5;
  result.x_rate *= x_scale;
  result.y_rate *= y_scale;
  result.surface.level = 0;
  result.level_rate = 0;
  return result;
}

/// a + f (b - a) for all f of `fraction`, within [0, 1].
Interval mixture(const Interval& a, const Interval& b, const Interval& fraction) {
  const auto at = [](double from, double to, double f) { return (1 - f) * from + f * to; };
  return {std::min(at(a.low, b.low, fraction.low), at(a.low, b.low, fraction.high)),
          std::max(at(a.high, b.high, fraction.low), at(a.high, b.high, fraction.high))};
}

/// Of the texture's value at `view`, between levels `k` and k + 1.
double value_rate(const RaySample& sample, double k) {
  const auto value_and_rate = [&](double level) {
    const RaySample projected = on_level(sample, level);
    const CellIndex index{std::floor(projected.surface.x), std::floor(projected.surface.y)};
    const Cell cell =
        cell_of(*projected.surface.texture, index, {projected.surface.x, projected.surface.x},
                {projected.surface.y, projected.surface.y});
    return std::pair(
        cell.value(cell.x.low, cell.y.low),
        cell.slope_x(cell.y.low) * projected.x_rate + cell.slope_y(cell.x.low) * projected.y_rate);
  };
  const auto [a, a_rate] = value_and_rate(k);
  const auto [b, b_rate] = value_and_rate(k + 1);
  const double f = sample.surface.level - k;
  return a_rate + f * (b_rate - a_rate) + sample.level_rate * (b - a);
}

}  // namespace

TextureRange texture_range(const RaySample& from, const RaySample& to, double length_s) {
  const HermiteCoordinate x = x_coordinate(from, to, length_s);
  const HermiteCoordinate y = y_coordinate(from, to, length_s);
  const Interval across = x.values();
  const Interval down = y.values();
  const CellIndex index = middle_cell(x, y);
  const Texture& texture = *from.surface.texture;
  if (is_within_cell(across, index.i) && is_within_cell(down, index.j)) {
    const Cell cell = cell_of(texture, index, across, down);
    const Interval along_x = product(cell.slopes_x(), x.rates());
    const Interval along_y = product(cell.slopes_y(), y.rates());
    return {cell.values(), {along_x.low + along_y.low, along_x.high + along_y.high}};
  }
  const TexelRange range = texture.range({across.low, across.high, down.low, down.high});
  return {{range.low, range.high}};
}

TextureRange mipmap_range(const RaySample& from, const RaySample& to, double length_s) {
  const Texture& texture = *from.surface.texture;
  const HermiteCoordinate level = level_coordinate(from, to, length_s);
  const Interval levels = level_values(level);
  const double last = coarsest(texture);
  if (levels.low >= last) return texture_range(on_level(from, last), on_level(to, last), length_s);
  const double k = middle_level(texture, level);
  if (is_within_cell(levels, k)) {
    const TextureRange a = texture_range(on_level(from, k), on_level(to, k), length_s);
    const TextureRange b = texture_range(on_level(from, k + 1), on_level(to, k + 1), length_s);
    const Interval fraction{std::max(levels.low - k, 0.0), std::min(levels.high - k, 1.0)};
    const Interval values = mixture(a.values, b.values, fraction);
    if (!(a.rates.high < RadianceRange::kUnknown && b.rates.high < RadianceRange::kUnknown))
      return {values};
    const Interval along = mixture(a.rates, b.rates, fraction);
    const Interval through =
        product(level.rates(), {b.values.low - a.values.high, b.values.high - a.values.low});
    return {values, {along.low + through.low, along.high + through.high}};
  }
  const Interval across = x_coordinate(from, to, length_s).values();
  const Interval down = y_coordinate(from, to, length_s).values();
  const TexelRange range =
      texture.range({across.low, across.high, down.low, down.high}, levels.low, levels.high);
  return {{range.low, range.high}};
}

double mipmap_split_fraction(const RaySample& from, const RaySample& to, double length_s) {
  const Texture& texture = *from.surface.texture;
  const HermiteCoordinate level = level_coordinate(from, to, length_s);
  const double last = coarsest(texture);
  if (std::min(level.from, level.to) >= last)
    return split_fraction(on_level(from, last), on_level(to, last), length_s);
  const double k = middle_level(texture, level);
  SplitPoint division;
  division.consider(level, k);
  division.consider(level, k + 1);
  for (const double each : {k, k + 1}) {
    const RaySample start = on_level(from, each);
    const RaySample end = on_level(to, each);
    division.consider_cell(x_coordinate(start, end, length_s), y_coordinate(start, end, length_s));
  }
  if (division.found()) return division.fraction();
  if (!is_within_cell(level_values(level), k)) return 0.5;
  const double a = value_rate(from, k);
  const double b = value_rate(to, k);
  return SplitPoint::inside(a / (a - b));
}

}  // namespace saccade
