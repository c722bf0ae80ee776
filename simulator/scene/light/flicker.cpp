#include "simulator/scene/light/flicker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

using std::numbers::pi;

double fraction(double phase) { return phase - std::floor(phase); }

/// Whether from <= k + offset <= to for some integer k.
bool meets(double from, double to, double offset) {
  return std::floor(to - offset) >= std::ceil(from - offset);
}

/// Of sin(2 pi x) over [from, to].
LightRange sine_range(double from, double to) {
  const auto [low, high] = std::minmax({std::sin(2 * pi * from), std::sin(2 * pi * to)});
  LightRange range{low, high, 0, 0};
  if (meets(from, to, 0.25)) range.high = 1;
  if (meets(from, to, 0.75)) range.low = -1;
  return range;
}

/// Of |sin(pi x)| and its derivative with respect to pi x. At a zero the derivative jumps from -1
/// to 1; an interval that begins or ends there, up to rounding, does not include the jump.
LightRange rectified_range(double from, double to) {
  const auto value = [](double x) { return std::sin(pi * fraction(x)); };
  const auto slope = [](double x) { return std::cos(pi * fraction(x)); };
  const double rounding = 1e-12 * (1 + std::abs(to));
  const auto [low, high] = std::minmax({value(from), value(to)});
  LightRange range{low, high, slope(to - rounding), slope(from + rounding)};
  if (meets(from, to, 0.5)) range.high = 1;
  if (meets(from, to, 0)) range.low = 0;
  if (meets(from + rounding, to - rounding, 0)) {
    range.rate_low = -1;
    range.rate_high = 1;
  }
  return range;
}

}  // namespace

void LightRange::add(const LightRange& other) {
  low += other.low;
  high += other.high;
  rate_low += other.rate_low;
  rate_high += other.rate_high;
}

void LightRange::include(const LightRange& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  rate_low = std::min(rate_low, other.rate_low);
  rate_high = std::max(rate_high, other.rate_high);
}

LightRange LightRange::times(const LightRange& other) const {
  // d(fg) = f dg + g df, each extreme where its factor is largest or, against the sign, smallest.
  const auto most = [](double rate, double least, double greatest) {
    return rate == 0 ? 0 : rate * (rate > 0 ? greatest : least);
  };
  const auto fewest = [](double rate, double least, double greatest) {
    return rate == 0 ? 0 : rate * (rate > 0 ? least : greatest);
  };
  LightRange range{low * other.low, high * other.high,
                   fewest(rate_low, other.low, other.high) + fewest(other.rate_low, low, high),
                   most(rate_high, other.low, other.high) + most(other.rate_high, low, high)};
  // Infinity times zero, of a jump in the dark.
  if (std::isnan(range.rate_low)) range.rate_low = -std::numeric_limits<double>::infinity();
  if (std::isnan(range.rate_high)) range.rate_high = std::numeric_limits<double>::infinity();
  return range;
}

Flicker::Flicker(const FlickerOptions& options) : options_(options) {}

double Flicker::at(double t_s) const {
  const double x = phase(t_s);
  switch (options_.waveform) {
    case Waveform::kSine:
      return 1 + options_.depth * std::sin(2 * pi * x);
    case Waveform::kMains:
      return 1 - options_.depth + options_.depth * (pi / 2) * std::sin(pi * fraction(x));
    default:
      return 1 - options_.depth +
             (fraction(x) < options_.duty ? options_.depth / options_.duty : 0);
  }
}

double Flicker::integral(double phase) const {
  const double cycles = std::floor(phase);
  const double rest = phase - cycles;
  switch (options_.waveform) {
    case Waveform::kSine:
      return phase + options_.depth * (1 - std::cos(2 * pi * rest)) / (2 * pi);
    case Waveform::kMains:
      return (1 - options_.depth) * phase +
             options_.depth * (cycles + 0.5 * (1 - std::cos(pi * rest)));
    default:
      return (1 - options_.depth) * phase +
             options_.depth * (cycles + std::min(rest / options_.duty, 1.0));
  }
}

double Flicker::mean(double t_s, double span_s) const {
  const double from = phase(t_s - 0.5 * span_s);
  const double to = phase(t_s + 0.5 * span_s);
  // Over shorter ones the difference of integrals would be rounding.
  constexpr double kLeastPhase = 1e-6;
  return to - from > kLeastPhase ? (integral(to) - integral(from)) / (to - from) : at(t_s);
}

LightRange Flicker::range(double from_s, double to_s) const {
  const double from = phase(from_s);
  const double to = phase(to_s);
  const double depth = options_.depth;
  if (options_.waveform == Waveform::kSine) {
    const LightRange sine = sine_range(from, to);
    const LightRange cosine = sine_range(from + 0.25, to + 0.25);
    const double rate = 2 * pi * options_.frequency_hz * depth;
    return {1 + depth * sine.low, 1 + depth * sine.high, rate * cosine.low, rate * cosine.high};
  }
  if (options_.waveform == Waveform::kMains) {
    const LightRange wave = rectified_range(from, to);
    const double swing = depth * (pi / 2);
    const double rate = pi * options_.frequency_hz * swing;
    return {1 - depth + swing * wave.low, 1 - depth + swing * wave.high, rate * wave.rate_low,
            rate * wave.rate_high};
  }
  if (jumps_until(from) == jumps_until(to)) return {at(from_s), at(from_s), 0, 0};
  constexpr double kJump = std::numeric_limits<double>::infinity();
  return {1 - depth, 1 - depth + depth / options_.duty, -kJump, kJump};
}

double Flicker::jumps_until(double phase) const {
  return 2 * std::floor(phase) + (fraction(phase) < options_.duty ? 0 : 1);
}

double Flicker::phase_of_jump(double index) const {
  const double cycle = std::floor(index / 2);
  return index == 2 * cycle ? cycle : cycle + options_.duty;
}

std::optional<double> Flicker::first_jump(double from_s, double to_s) const {
  if (options_.waveform != Waveform::kSquare || options_.depth == 0) return std::nullopt;
  const double jump_s = time_of(phase_of_jump(jumps_until(phase(from_s)) + 1));
  if (jump_s > from_s && jump_s < to_s) return jump_s;
  return std::nullopt;
}

void Flicker::find_breaks(double from_s, double to_s, double around_s,
                          std::vector<double>& times_s) const {
  if (options_.depth == 0) return;
  const auto add = [&](double t_s) {
    if (t_s > from_s && t_s < to_s) times_s.push_back(t_s);
  };
  if (options_.waveform == Waveform::kSquare) {
    const double last = jumps_until(phase(to_s)) + 1;
    for (double index = jumps_until(phase(from_s)); index <= last; ++index) {
      const double jump_s = time_of(phase_of_jump(index));
      add(jump_s - around_s);
      add(jump_s + around_s);
    }
    return;
  }
  // Extrema, and of the rectified sine the zeros: every half period.
  const double first = options_.waveform == Waveform::kSine ? 0.25 : 0.0;
  const double last = std::ceil(2 * (phase(to_s) - first));
  for (double k = std::floor(2 * (phase(from_s) - first)); k <= last; ++k)
    add(time_of(first + 0.5 * k));
}

std::optional<double> first_jump(std::span<const Flicker> flickers, double from_s, double to_s) {
  std::optional<double> first;
  for (const Flicker& flicker : flickers)
    if (const auto jump_s = flicker.first_jump(from_s, first.value_or(to_s))) first = jump_s;
  return first;
}

double shortest_period_s(std::span<const Flicker> flickers) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Flicker& flicker : flickers) shortest = std::min(shortest, flicker.period_s());
  return shortest;
}

void describe(config::Fields& fields, FlickerOptions& options) {
  fields
      .value("frequency_hz", options.frequency_hz,
             "Periods of the flicker per second: of lamps on the mains twice the frequency of the "
             "mains, 100 or 120.")
      .above(0)
      .at_most(1e5);
  fields.choice(
      "waveform", options.waveform,
      {{"sine", Waveform::kSine}, {"mains", Waveform::kMains}, {"square", Waveform::kSquare}},
      "Course of the light over a period. sine oscillates around the mean; mains is a "
      "rectified sine with kinks where it is darkest; square is on and then off, as an "
      "LED that is dimmed by pulse width modulation. The mean over a period is the "
      "intensity.");
  fields
      .value("depth", options.depth,
             "Depth of the modulation: 0 is a steady light, with 1 the light goes out in every "
             "period.")
      .range(0, 1);
  if (options.waveform == Waveform::kSquare)
    fields
        .value("duty", options.duty,
               "Fraction of a period in which the light is on; the on-state is the brighter the "
               "shorter it is.")
        .above(0)
        .below(1);
  fields
      .value("phase_deg", options.phase_deg,
             "Phase at time 0 of the recording, in degrees of the period: sine starts at the mean "
             "and rises, mains starts at its darkest, square is switched on.")
      .range(-360, 360);
}

}  // namespace saccade
