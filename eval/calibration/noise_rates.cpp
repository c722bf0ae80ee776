#include "eval/calibration/noise_rates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/image.h"

namespace saccade {
namespace {

struct Reach {
  int px;
  TimeNs ns;
};
/// From the strictest on.
constexpr Reach kReaches[] = {{4, 40'000'000}, {3, 20'000'000}, {2, 10'000'000}, {1, 5'000'000}};
/// Isolated events with which a neighbourhood is taken: 10 % of the rate as one sigma, and of each
/// polarity. More would ask for smaller neighbourhoods, in which weak texture counts as noise.
constexpr std::size_t kEnough = 100, kEnoughOfEach = 20;
constexpr std::size_t kLeastHot = 5;

/// Where and when no other pixel nearby fires.
struct QuietPart {
  std::vector<bool> isolated;   ///< of each event
  Image<double> pixel_seconds;  ///< per pixel
};

template <class Use>
void for_others_within(const Event& event, SensorSize size, int reach, const Use& use) {
  for (int y = std::max(event.y - reach, 0); y <= std::min(event.y + reach, size.height - 1); ++y)
    for (int x = std::max(event.x - reach, 0); x <= std::min(event.x + reach, size.width - 1); ++x)
      if (x != event.x || y != event.y) use(x, y);
}

/// Adds up per pixel the time that no event of another pixel covers from reach before it to reach
/// after it, and marks the events that none covers.
QuietPart quiet_part(std::span<const Event> events, SensorSize size, const Reach& reach) {
  const TimeNs start_ns = events.front().t_ns, end_ns = events.back().t_ns;
  QuietPart quiet{std::vector<bool>(events.size(), true), Image<double>(size.width, size.height)};
  Image<TimeNs> covered_until(size.width, size.height, start_ns);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    if (event.t_ns < covered_until(event.x, event.y)) quiet.isolated[i] = false;
    for_others_within(event, size, reach.px, [&](int x, int y) {
      TimeNs& until = covered_until(x, y);
      const TimeNs from = std::max(event.t_ns - reach.ns, start_ns);
      if (from > until) quiet.pixel_seconds(x, y) += seconds_from_ns(from - until);
      until = event.t_ns + reach.ns;
    });
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (end_ns > covered_until(x, y))
        quiet.pixel_seconds(x, y) += seconds_from_ns(end_ns - covered_until(x, y));
  // Backwards for what comes after an event.
  Image<TimeNs> covered_from(size.width, size.height, end_ns + 1);
  for (std::size_t i = events.size(); i-- > 0;) {
    const Event& event = events[i];
    if (event.t_ns > covered_from(event.x, event.y)) quiet.isolated[i] = false;
    for_others_within(event, size, reach.px,
                      [&](int x, int y) { covered_from(x, y) = event.t_ns - reach.ns; });
  }
  return quiet;
}

struct Counts {
  Image<std::size_t> on, off;
  [[nodiscard]] std::size_t at(int x, int y) const { return on(x, y) + off(x, y); }
};

Counts isolated_counts(std::span<const Event> events, SensorSize size, const QuietPart& quiet) {
  Counts counts{Image<std::size_t>(size.width, size.height),
                Image<std::size_t>(size.width, size.height)};
  for (std::size_t i = 0; i < events.size(); ++i)
    if (quiet.isolated[i])
      ++(events[i].polarity > 0 ? counts.on : counts.off)(events[i].x, events[i].y);
  return counts;
}

/// Whether a Poisson process of mean `mean` gives `count` or more to any of `pixels` pixels with a
/// probability below 1 %, by Chernoff's bound.
bool is_improbable(double count, double mean, double pixels) {
  if (count <= mean) return false;
  const double exponent = mean > 0 ? count * std::log(count / mean) - count + mean : 1e300;
  return exponent > std::log(100 * pixels);
}

/// Sums over the pixels that are not hot; twice, since hot ones raise the rate that tells them.
NoiseRates rates_of(const Counts& counts, const Image<double>& seconds) {
  const int width = seconds.width(), height = seconds.height();
  const auto pixels = static_cast<double>(seconds.size());
  NoiseRates rates;
  Image<std::uint8_t> hot(width, height);
  for (int round = 0; round < 3; ++round) {
    std::size_t on = 0, off = 0;
    rates.pixel_seconds = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (hot(x, y) != 0) continue;
        on += counts.on(x, y);
        off += counts.off(x, y);
        rates.pixel_seconds += seconds(x, y);
      }
    if (rates.pixel_seconds <= 0) return rates;
    rates.on = counted_rate(on, rates.pixel_seconds);
    rates.off = counted_rate(off, rates.pixel_seconds);
    rates.hot.clear();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto count = counts.at(x, y);
        const double mean = (rates.on.hz + rates.off.hz) * seconds(x, y);
        hot(x, y) = count >= kLeastHot && is_improbable(static_cast<double>(count), mean, pixels);
        if (hot(x, y) != 0) rates.hot.push_back({x, y, static_cast<double>(count) / seconds(x, y)});
      }
  }
  return rates;
}

}  // namespace

CountedRate counted_rate(std::size_t count, double seconds) {
  const auto n = static_cast<double>(count);
  constexpr double kZ = 1.96;
  const auto bound = [&](double k, double z) {
    return k <= 0 ? 0 : k * std::pow(1 - 1 / (9 * k) + z / (3 * std::sqrt(k)), 3);
  };
  return {n / seconds, bound(n, -kZ) / seconds, bound(n + 1, kZ) / seconds, count};
}

NoiseRates noise_rates(std::span<const Event> events, SensorSize size) {
  SACCADE_CHECK(events.size() >= 2 && events.front().t_ns < events.back().t_ns);
  const double duration_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  NoiseRates rates;
  for (const Reach& reach : kReaches) {
    const QuietPart quiet = quiet_part(events, size, reach);
    rates = rates_of(isolated_counts(events, size, quiet), quiet.pixel_seconds);
    rates.reach_px = reach.px;
    rates.reach_s = seconds_from_ns(reach.ns);
    if (rates.on.count + rates.off.count >= kEnough &&
        std::min(rates.on.count, rates.off.count) >= kEnoughOfEach)
      break;
  }
  rates.quiet_fraction =
      rates.pixel_seconds / (duration_s * static_cast<double>(size.width) * size.height);
  constexpr double kMuch = 0.3;
  rates.is_told = rates.reach_px > 1 || rates.quiet_fraction > kMuch;
  return rates;
}

}  // namespace saccade
