#include "eval/calibration/stream_distance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/blind_time.h"
#include "core/check.h"

namespace saccade {
namespace {

constexpr TimeNs kRateBinNs = 5'000'000;
constexpr int kMapBlockPx = 8;

double on_fraction(std::span<const Event> events) {
  const auto on = std::ranges::count_if(events, [](const Event& e) { return e.polarity > 0; });
  return static_cast<double>(on) / static_cast<double>(events.size());
}

/// Total variation distance of two histograms over the keys that `key_of` gives.
template <class KeyOf>
double total_variation(std::span<const Event> a, std::span<const Event> b, const KeyOf& key_of) {
  std::map<std::int64_t, double> difference;
  for (const Event& event : a) difference[key_of(event)] += 1 / static_cast<double>(a.size());
  for (const Event& event : b) difference[key_of(event)] -= 1 / static_cast<double>(b.size());
  double sum = 0;
  for (const auto& [key, value] : difference) sum += std::abs(value);
  return sum / 2;
}

}  // namespace

double gap_distance(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) return 0;
  // The area between two step functions, from one step of either to the next.
  double area = 0, before = 0;
  std::size_t i = 0, j = 0;
  for (bool is_first = true; i < a.size() || j < b.size(); is_first = false) {
    const bool takes_a = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const double at = std::log10(std::max(takes_a ? a[i] : b[j], 1e-3));
    const double fraction_a = static_cast<double>(i) / static_cast<double>(a.size());
    const double fraction_b = static_cast<double>(j) / static_cast<double>(b.size());
    if (!is_first) area += std::abs(fraction_a - fraction_b) * (at - before);
    before = at;
    ++(takes_a ? i : j);
  }
  return area;
}

StreamDistance stream_distance(std::span<const Event> recorded, std::span<const Event> simulated,
                               SensorSize size) {
  SACCADE_CHECK(!recorded.empty() && !simulated.empty());
  const auto rate_key = [](const Event& event) { return event.t_ns / kRateBinNs; };
  const auto map_key = [&](const Event& event) {
    return static_cast<std::int64_t>(event.y / kMapBlockPx) * size.width + event.x / kMapBlockPx;
  };
  return {static_cast<double>(simulated.size()) / static_cast<double>(recorded.size()),
          100 * (on_fraction(simulated) - on_fraction(recorded)),
          gap_distance(event_gaps_us(recorded, size), event_gaps_us(simulated, size)),
          total_variation(recorded, simulated, rate_key),
          total_variation(recorded, simulated, map_key)};
}

}  // namespace saccade
