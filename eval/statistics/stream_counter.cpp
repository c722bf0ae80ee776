#include "eval/statistics/stream_counter.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/image.h"
#include "eval/recording.h"
#include "eval/statistics/pixel_counts.h"

namespace saccade {
namespace {

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::min();

/// The image on a larger sensor, `fill` where it was not; `margin`: pixels around the sensor.
template <class T>
void enlarge(Image<T>& image, SensorSize size, T fill, int margin = 0) {
  Image<T> larger(size.width + 2 * margin, size.height + 2 * margin, fill);
  for (int y = 0; y < image.height() - margin; ++y)
    for (int x = 0; x < image.width() - margin; ++x) larger(x, y) = image(x, y);
  image = std::move(larger);
}

/// Gaps between the events of one pixel.
class GapCounter {
 public:
  void enlarge_to(SensorSize size) { enlarge(last_, size, {kNever, 0}); }

  void add(const Event& event) {
    Last& before = last_(event.x, event.y);
    if (before.t_ns != kNever) {
      const double gap_us = static_cast<double>(event.t_ns - before.t_ns) * 1e-3;
      const bool is_same = event.polarity == before.polarity;
      (is_same ? gaps_.same : gaps_.opposite).add(gap_us);
      all_.add(gap_us);
      ++count_;
      if (!is_same) ++opposite_;
      shortest_us_ = std::min(shortest_us_, gap_us);
      longest_us_ = std::max(longest_us_, gap_us);
    }
    before = {event.t_ns, event.polarity};
  }

  [[nodiscard]] EventGaps gaps() && {
    if (count_ == 0) return std::move(gaps_);
    // The first bin also holds gaps of 0.
    const auto ranked_us = [&](std::size_t rank) {
      const std::size_t bin = all_.bin_of_rank(rank);
      return bin == 0 ? shortest_us_ : std::clamp(all_.middle(bin), shortest_us_, longest_us_);
    };
    gaps_.opposite_fraction = static_cast<double>(opposite_) / static_cast<double>(count_);
    gaps_.shortest_us = shortest_us_;
    gaps_.floor_us = ranked_us(count_ / 1000);
    gaps_.median_us = ranked_us(count_ / 2);
    return std::move(gaps_);
  }

 private:
  struct Last {
    TimeNs t_ns = kNever;
    std::int8_t polarity = 0;
  };
  static constexpr int kDecades = 7, kPerDecade = 8;
  // From 1 ns to a day; a bin is 0.06 % wide.
  static constexpr int kFineDecades = 14, kFinePerDecade = 4000;

  Image<Last> last_;
  EventGaps gaps_{LogHistogram(1, kDecades, kPerDecade), LogHistogram(1, kDecades, kPerDecade)};
  LogHistogram all_{1e-3, kFineDecades, kFinePerDecade};
  std::size_t count_ = 0, opposite_ = 0;
  double shortest_us_ = std::numeric_limits<double>::infinity();
  double longest_us_ = 0;
};

/// Counts the events that no neighbouring pixel's lies within kSupportNs of. One without any before
/// it waits until all that can lie close behind it have come.
class IsolatedCounter {
 public:
  void enlarge_to(SensorSize size) { enlarge(last_ns_, size, kNever, 1); }

  void add(const Event& event) {
    while (!waiting_.empty() && event.t_ns - waiting_.front().t_ns > kSupportNs) settle_first();
    if (newest_around(event) < event.t_ns - kSupportNs) waiting_.push_back(event);
    last_ns_(event.x + 1, event.y + 1) = event.t_ns;
  }

  [[nodiscard]] std::size_t count() && {
    while (!waiting_.empty()) settle_first();
    return count_;
  }

 private:
  static constexpr TimeNs kSupportNs = 5'000'000;

  [[nodiscard]] TimeNs newest_around(const Event& event) const {
    const int x = event.x + 1, y = event.y + 1;
    TimeNs newest = std::max(last_ns_(x - 1, y), last_ns_(x + 1, y));
    for (int i = x - 1; i <= x + 1; ++i)
      newest = std::max({newest, last_ns_(i, y - 1), last_ns_(i, y + 1)});
    return newest;
  }

  void settle_first() {
    if (newest_around(waiting_.front()) < waiting_.front().t_ns) ++count_;
    waiting_.pop_front();
  }

  Image<TimeNs> last_ns_;  ///< of each pixel, with a margin of one around the sensor
  std::deque<Event> waiting_;
  std::size_t count_ = 0;
};

}  // namespace

struct StreamCounter::State {
  SensorSize size;
  bool is_size_given;
  double rate_bin_s;
  TimeNs rate_bin_ns;
  std::size_t events = 0;
  TimeNs first_ns = 0, last_ns = 0;
  PixelCounts counts;
  GapCounter gaps;
  IsolatedCounter isolated;
  std::vector<RateBin> rates;

  void enlarge_to(SensorSize larger) {
    size = larger;
    enlarge(counts.on, size, std::size_t{0});
    enlarge(counts.off, size, std::size_t{0});
    gaps.enlarge_to(size);
    isolated.enlarge_to(size);
  }

  void make_room_for(std::span<const Event> added) {
    const SensorSize needed = extent(added);
    if (needed.width <= size.width && needed.height <= size.height) return;
    SACCADE_CHECK(!is_size_given);
    enlarge_to({std::max(size.width, needed.width), std::max(size.height, needed.height)});
  }

  void count_rate(const Event& event) {
    const auto bin = static_cast<std::size_t>((event.t_ns - first_ns) / rate_bin_ns);
    while (rates.size() <= bin)
      rates.push_back({static_cast<double>(rates.size()) * rate_bin_s, 0, 0});
    (event.polarity > 0 ? rates[bin].on_hz : rates[bin].off_hz) += 1 / rate_bin_s;
  }
};

StreamCounter::StreamCounter(SensorSize size, double rate_bin_s)
    : state_(std::make_unique<State>()) {
  state_->is_size_given = size.width > 0;
  state_->rate_bin_s = rate_bin_s;
  state_->rate_bin_ns = ns_from_seconds(rate_bin_s);
  SACCADE_CHECK(state_->rate_bin_ns > 0);
  if (state_->is_size_given) state_->enlarge_to(size);
}

StreamCounter::~StreamCounter() = default;
StreamCounter::StreamCounter(StreamCounter&&) noexcept = default;
StreamCounter& StreamCounter::operator=(StreamCounter&&) noexcept = default;

void StreamCounter::add(std::span<const Event> events) {
  if (events.empty()) return;
  State& state = *state_;
  state.make_room_for(events);
  if (state.events == 0) state.first_ns = events.front().t_ns;
  state.events += events.size();
  state.last_ns = events.back().t_ns;
  for (const Event& event : events) {
    ++(event.polarity > 0 ? state.counts.on : state.counts.off)(event.x, event.y);
    state.gaps.add(event);
    state.isolated.add(event);
    state.count_rate(event);
  }
}

StreamStatistics StreamCounter::statistics() && {
  State& state = *state_;
  SACCADE_CHECK(state.events >= 2 && state.first_ns < state.last_ns);
  const double duration_s = seconds_from_ns(state.last_ns - state.first_ns);
  const double pixel_seconds = duration_s * static_cast<double>(state.counts.on.size());
  const auto all = static_cast<double>(state.events);
  const auto isolated = static_cast<double>(std::move(state.isolated).count());
  NoiseSigns noise = quiet_rates(state.counts, duration_s);
  noise.isolated_fraction = isolated / all;
  noise.isolated_hz = isolated / pixel_seconds;
  const std::span<const std::size_t> on = state.counts.on.pixels();
  state.rates.pop_back();  // the last one is not full
  return {.events = state.events,
          .duration_s = duration_s,
          .pixel_rate_hz = all / pixel_seconds,
          .on_fraction =
              static_cast<double>(std::accumulate(on.begin(), on.end(), std::size_t{0})) / all,
          .rates = std::move(state.rates),
          .gaps = std::move(state.gaps).gaps(),
          .pixels = pixel_rates(state.counts, duration_s),
          .noise = noise};
}

StreamStatistics stream_statistics(std::span<const Event> events, SensorSize size,
                                   double rate_bin_s) {
  StreamCounter counter(size, rate_bin_s);
  counter.add(events);
  return std::move(counter).statistics();
}

}  // namespace saccade
