#include "eval/statistics/stream_statistics.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <optional>

#include "core/check.h"
#include "core/image.h"

namespace saccade {
namespace {

constexpr TimeNs kSupportNs = 5'000'000;
constexpr int kBlockPx = 10;
constexpr std::size_t kQuietBlocks = 10;  // one block in so many
constexpr std::size_t kHotCount = 10;
constexpr std::size_t kHotTimes = 5;

struct PixelCounts {
  Image<std::size_t> on, off;

  PixelCounts(std::span<const Event> events, SensorSize size)
      : on(size.width, size.height), off(size.width, size.height) {
    for (const Event& event : events) ++(event.polarity > 0 ? on : off)(event.x, event.y);
  }
  [[nodiscard]] std::size_t at(int x, int y) const { return on(x, y) + off(x, y); }
};

template <class Visit>
void for_neighbours(SensorSize size, int x, int y, const Visit& visit) {
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size.width - 1); ++i)
      if (i != x || j != y) visit(i, j);
}

EventGaps gaps_of(std::span<const Event> events, SensorSize size) {
  constexpr int kDecades = 7, kPerDecade = 8;
  EventGaps gaps{LogHistogram(1, kDecades, kPerDecade), LogHistogram(1, kDecades, kPerDecade)};
  Image<std::optional<Event>> last(size.width, size.height);
  std::vector<double> all_us;
  std::size_t opposite = 0;
  for (const Event& event : events) {
    std::optional<Event>& before = last(event.x, event.y);
    if (before) {
      all_us.push_back(static_cast<double>(event.t_ns - before->t_ns) * 1e-3);
      const bool is_same = event.polarity == before->polarity;
      (is_same ? gaps.same : gaps.opposite).add(all_us.back());
      if (!is_same) ++opposite;
    }
    before = event;
  }
  if (all_us.empty()) return gaps;
  gaps.opposite_fraction = static_cast<double>(opposite) / static_cast<double>(all_us.size());
  std::sort(all_us.begin(), all_us.end());
  gaps.shortest_us = all_us.front();
  gaps.floor_us = all_us[all_us.size() / 1000];
  gaps.median_us = all_us[all_us.size() / 2];
  return gaps;
}

std::size_t hot_pixels(const PixelCounts& counts, SensorSize size) {
  std::size_t hot = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (counts.at(x, y) < kHotCount) continue;
      std::vector<std::size_t> around;
      for_neighbours(size, x, y, [&](int i, int j) { around.push_back(counts.at(i, j)); });
      if (around.empty()) continue;
      std::nth_element(around.begin(), around.begin() + std::ssize(around) / 2, around.end());
      if (counts.at(x, y) > kHotTimes * (around[around.size() / 2] + 1)) ++hot;
    }
  return hot;
}

PixelRates pixel_rates(const PixelCounts& counts, SensorSize size, double duration_s) {
  PixelRates rates;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      rates.ascending_hz.push_back(static_cast<double>(counts.at(x, y)) / duration_s);
  std::vector<double>& all = rates.ascending_hz;
  std::sort(all.begin(), all.end());
  const auto silent = std::distance(all.begin(), std::upper_bound(all.begin(), all.end(), 0.0));
  rates.silent_fraction = static_cast<double>(silent) / static_cast<double>(all.size());
  rates.hot_pixels = hot_pixels(counts, size);
  return rates;
}

/// Marks the events that one of a neighbouring pixel comes before by at most kSupportNs; `order`:
/// their indices, forwards or backwards in time.
void mark_supported(std::span<const std::size_t> order, std::span<const Event> events,
                    SensorSize size, std::vector<bool>& supported) {
  Image<std::optional<TimeNs>> last(size.width, size.height);
  for (const std::size_t index : order) {
    const Event& event = events[index];
    for_neighbours(size, event.x, event.y, [&](int i, int j) {
      const std::optional<TimeNs>& t_ns = last(i, j);
      if (t_ns && std::abs(event.t_ns - *t_ns) <= kSupportNs) supported[index] = true;
    });
    last(event.x, event.y) = event.t_ns;
  }
}

double isolated_fraction(std::span<const Event> events, SensorSize size) {
  std::vector<std::size_t> order(events.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<bool> supported(events.size());
  mark_supported(order, events, size, supported);
  std::reverse(order.begin(), order.end());
  mark_supported(order, events, size, supported);
  const auto isolated = std::count(supported.begin(), supported.end(), false);
  return static_cast<double>(isolated) / static_cast<double>(events.size());
}

NoiseSigns noise_signs(std::span<const Event> events, const PixelCounts& counts, SensorSize size,
                       double duration_s) {
  struct Block {
    std::size_t on = 0, off = 0;
  };
  std::vector<Block> blocks;
  for (int top = 0; top + kBlockPx <= size.height; top += kBlockPx)
    for (int left = 0; left + kBlockPx <= size.width; left += kBlockPx) {
      Block& block = blocks.emplace_back();
      for (int y = top; y < top + kBlockPx; ++y)
        for (int x = left; x < left + kBlockPx; ++x) {
          block.on += counts.on(x, y);
          block.off += counts.off(x, y);
        }
    }
  NoiseSigns noise;
  noise.isolated_fraction = isolated_fraction(events, size);
  noise.isolated_hz = noise.isolated_fraction * static_cast<double>(events.size()) / duration_s /
                      static_cast<double>(counts.on.size());
  if (blocks.empty()) return noise;
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.on + a.off < b.on + b.off; });
  blocks.resize(std::max<std::size_t>(1, blocks.size() / kQuietBlocks));
  const double pixel_seconds =
      static_cast<double>(blocks.size()) * kBlockPx * kBlockPx * duration_s;
  for (const Block& block : blocks) {
    noise.quiet_on_hz += static_cast<double>(block.on) / pixel_seconds;
    noise.quiet_off_hz += static_cast<double>(block.off) / pixel_seconds;
  }
  return noise;
}

std::vector<RateBin> rates_over_time(std::span<const Event> events, double bin_s) {
  const TimeNs bin_ns = ns_from_seconds(bin_s);
  const auto bin_of = [&](const Event& event) {
    return static_cast<std::size_t>((event.t_ns - events.front().t_ns) / bin_ns);
  };
  std::vector<RateBin> rates(bin_of(events.back()));
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i].t_s = static_cast<double>(i) * bin_s;
  for (const Event& event : events)
    if (const std::size_t bin = bin_of(event); bin < rates.size())
      (event.polarity > 0 ? rates[bin].on_hz : rates[bin].off_hz) += 1 / bin_s;
  return rates;
}

}  // namespace

StreamStatistics stream_statistics(std::span<const Event> events, SensorSize size,
                                   double rate_bin_s) {
  SACCADE_CHECK(events.size() >= 2 && events.front().t_ns < events.back().t_ns);
  SACCADE_CHECK(ns_from_seconds(rate_bin_s) > 0);
  const double duration_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  const PixelCounts counts(events, size);
  const auto all = static_cast<double>(events.size());
  const auto on = std::count_if(events.begin(), events.end(),
                                [](const Event& event) { return event.polarity > 0; });
  return {.events = events.size(),
          .duration_s = duration_s,
          .pixel_rate_hz = all / duration_s / static_cast<double>(counts.on.size()),
          .on_fraction = static_cast<double>(on) / all,
          .rates = rates_over_time(events, rate_bin_s),
          .gaps = gaps_of(events, size),
          .pixels = pixel_rates(counts, size, duration_s),
          .noise = noise_signs(events, counts, size, duration_s)};
}

}  // namespace saccade
