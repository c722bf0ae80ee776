#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/events/events_h5.h"
#include "core/io/events/events_h5_layout.h"
#include "core/io/events/packed_columns.h"
#include "core/io/tables/h5_file.h"
#include "core/process/parallel.h"
#include "core/time_search.h"

namespace saccade {
namespace {

constexpr std::uint64_t kH5Block = std::uint64_t{1} << 20;  // events in memory besides the result
constexpr std::size_t kH5Grain = std::size_t{1} << 16;      // that one thread makes at a time

/// Smallest tick whose time is not before `t_ns`.
std::int64_t ceil_ticks(TimeNs t_ns, TimeNs unit) {
  return t_ns / unit + static_cast<std::int64_t>(t_ns % unit > 0);
}

std::int64_t saturating_subtract(std::int64_t a, std::int64_t b) {
  std::int64_t result = 0;
  if (!__builtin_sub_overflow(a, b, &result)) return result;
  return a < 0 ? std::numeric_limits<std::int64_t>::min()
               : std::numeric_limits<std::int64_t>::max();
}

}  // namespace

struct EventH5Reader::State : EventH5Layout {
  explicit State(const std::filesystem::path& path) : EventH5Layout(path) {
    const H5Lock lock;
    if (!times_in_seconds && x.field.empty())
      packed = PackedColumns::of(x.dataset, y.dataset, p.dataset, t.dataset);
  }

  [[nodiscard]] std::vector<std::int64_t> read_seconds(EventRange range) const;
  [[nodiscard]] std::vector<std::int64_t> read_times(EventRange range) const;
  void check_order(std::span<const std::int64_t> times, std::uint64_t first) const;
  void read_columns(EventRange range, EventColumns& columns) const;
  [[nodiscard]] EventRange bracket(std::int64_t start_tick, std::int64_t end_tick) const;
  [[nodiscard]] EventRange find(TimeWindow window) const;
  [[nodiscard]] TimeNs time_ns(std::int64_t tick, std::uint64_t index) const;
  void append_block(EventRange range, SensorSize size, Events& events) const;
  [[nodiscard]] bool make_events(const EventColumns& columns, SensorSize size,
                                 std::span<Event> events) const;
  [[noreturn]] void report(const EventColumns& columns, std::uint64_t first, SensorSize size,
                           TimeNs last_ns) const;

  std::optional<PackedColumns> packed;  ///< the columns, where they are stored so
};

/// Seconds as whole microseconds, which is what cameras measure.
std::vector<std::int64_t> EventH5Reader::State::read_seconds(EventRange range) const {
  std::vector<double> seconds;
  read(t, H5T_NATIVE_DOUBLE, range, seconds);
  std::vector<std::int64_t> times(seconds.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!(std::abs(seconds[i]) < 9e9))
      fail_at(t.path, range.begin + i, fmt::format("{} s is no time", seconds[i]));
    times[i] = std::llround(1e6 * seconds[i]);
  }
  return times;
}

std::vector<std::int64_t> EventH5Reader::State::read_times(EventRange range) const {
  std::vector<std::int64_t> times;
  if (times_in_seconds)
    times = read_seconds(range);
  else
    read(t, H5T_NATIVE_INT64, range, times);
  check_order(times, range.begin);
  return times;
}

void EventH5Reader::State::check_order(std::span<const std::int64_t> times,
                                       std::uint64_t first) const {
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] < times[i - 1])
      fail_at(
          t.path, first + i,
          "time goes back: " + std::to_string(times[i]) + " after " + std::to_string(times[i - 1]));
}

/// A range of indices that holds all events with start_tick <= t < end_tick, by the index.
EventRange EventH5Reader::State::bracket(std::int64_t start_tick, std::int64_t end_tick) const {
  EventRange range{0, count};
  if (!ms_to_idx || ms_to_idx->empty()) return range;
  const std::int64_t ticks_per_ms = 1'000'000 / unit;
  const auto length = static_cast<std::int64_t>(ms_to_idx->size());
  const std::int64_t first_ms = std::clamp<std::int64_t>(start_tick / ticks_per_ms, 0, length - 1);
  if (start_tick > 0) range.begin = (*ms_to_idx)[static_cast<std::size_t>(first_ms)];
  if (end_tick < (length - 1) * ticks_per_ms) {
    const std::int64_t last_ms = std::max<std::int64_t>(end_tick, 0) / ticks_per_ms + 1;
    range.end = (*ms_to_idx)[static_cast<std::size_t>(last_ms)];
  }
  // The neighbours outside prove that the index tells the truth.
  const auto tick_at = [&](std::uint64_t i) { return read_times({i, i + 1}).front(); };
  if ((range.begin > 0 && tick_at(range.begin - 1) >= start_tick) ||
      (range.end < count && tick_at(range.end) < end_tick))
    fail("/ms_to_idx", "contradicts the times in /events/t");
  return range;
}

/// The events of the window, by bisection over blocks within the bracket.
EventRange EventH5Reader::State::find(TimeWindow window) const {
  const std::int64_t start = saturating_subtract(ceil_ticks(window.start_ns, unit), offset);
  const std::int64_t end = saturating_subtract(ceil_ticks(window.end_ns, unit), offset);
  if (start >= end || count == 0) return {};
  const EventRange range = bracket(start, end);
  const auto first_at_or_after = [&](std::int64_t tick) {
    std::uint64_t low = range.begin;
    std::uint64_t high = range.end;
    // About a chunk, which has to be unpacked anyway.
    while (high - low > kH5Grain) {
      const std::uint64_t middle = low + (high - low) / 2;
      if (read_times({middle, middle + 1}).front() < tick)
        low = middle + 1;
      else
        high = middle;
    }
    return low + count_before(read_times({low, high}), tick, std::identity{});
  };
  constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  return {window.start_ns == kAlways ? range.begin : first_at_or_after(start),
          window.end_ns == kNever ? range.end : first_at_or_after(end)};
}

TimeNs EventH5Reader::State::time_ns(std::int64_t tick, std::uint64_t index) const {
  TimeNs t_ns = 0;
  if (__builtin_add_overflow(tick, offset, &t_ns) || __builtin_mul_overflow(t_ns, unit, &t_ns))
    fail_at(t.path, index, "the time is too large: " + std::to_string(tick));
  return t_ns;
}

/// By the library where the chunks are stored in a way that only it knows, or are damaged, which it
/// reports.
void EventH5Reader::State::read_columns(EventRange range, EventColumns& columns) const {
  if (packed && packed->read(range.begin, range.end, columns)) return;
  const H5Lock lock;
  read(x, H5T_NATIVE_UINT16, range, columns.x);
  read(y, H5T_NATIVE_UINT16, range, columns.y);
  read(p, H5T_NATIVE_INT16, range, columns.p);
  columns.t = read_times(range);
}

/// False where one of them cannot be an event, or comes before its predecessor.
bool EventH5Reader::State::make_events(const EventColumns& columns, SensorSize size,
                                       std::span<Event> events) const {
  const int width = size.width > 0 ? size.width : 65536;
  const int height = size.height > 0 ? size.height : 65536;
  const int lowest = place == "/events" ? 0 : -1;
  // Between these no time overflows.
  const std::int64_t highest =
      saturating_subtract(std::numeric_limits<TimeNs>::max() / unit, offset);
  const std::int64_t least = saturating_subtract(std::numeric_limits<TimeNs>::min() / unit, offset);
  std::atomic<bool> is_sound = true;
  const auto make = [&](std::size_t begin, std::size_t end) {
    bool is_fine = true;
    std::int64_t before = columns.t[begin > 0 ? begin - 1 : 0];
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t tick = columns.t[i];
      const int p_of = columns.p[i];
      // Without a branch, which would keep the loop from several events at a time.
      is_fine &= static_cast<bool>(
          static_cast<int>(columns.x[i] < width) & static_cast<int>(columns.y[i] < height) &
          static_cast<int>(p_of <= 1) & static_cast<int>(p_of >= lowest) &
          static_cast<int>(tick >= std::max(least, before)) & static_cast<int>(tick <= highest));
      before = tick;
      // Unsigned, because a time that is refused may overflow.
      const std::uint64_t t_ns =
          (static_cast<std::uint64_t>(tick) + static_cast<std::uint64_t>(offset)) *
          static_cast<std::uint64_t>(unit);
      events[i] = {static_cast<TimeNs>(t_ns), columns.x[i], columns.y[i],
                   static_cast<std::int8_t>(p_of == 1 ? 1 : -1)};
    }
    if (!is_fine) is_sound = false;
  };
  parallel_for_ranges(events.size(), kH5Grain, make);
  return is_sound;
}

/// Throws for the first thing that is wrong.
void EventH5Reader::State::report(const EventColumns& columns, std::uint64_t first, SensorSize size,
                                  TimeNs last_ns) const {
  const auto& [xs, ys, ps, ts] = columns;
  check_order(ts, first);
  const int width = size.width > 0 ? size.width : 65536;
  const int height = size.height > 0 ? size.height : 65536;
  const int lowest = place == "/events" ? 0 : -1;
  for (std::size_t i = 0; i < ts.size(); ++i) {
    const TimeNs t_ns = time_ns(ts[i], first + i);
    if (t_ns < last_ns) fail_at(t.path, first + i, "time goes back");
    if (xs[i] >= width || ys[i] >= height)
      fail_at((xs[i] >= width ? x : y).path, first + i,
              "pixel (" + std::to_string(xs[i]) + ", " + std::to_string(ys[i]) +
                  ") lies outside the sensor of " + std::to_string(width) + " x " +
                  std::to_string(height) + " px");
    if (ps[i] > 1 || ps[i] < lowest)
      fail_at(p.path, first + i,
              "polarity " + std::to_string(ps[i]) +
                  (lowest == 0 ? " must be 0 or 1" : " must be 1, 0 or -1"));
  }
  fail_at(t.path, first, "a time is too large");
}

void EventH5Reader::State::append_block(EventRange range, SensorSize size, Events& events) const {
  EventColumns columns;
  read_columns(range, columns);
  const TimeNs last_ns = events.empty() ? std::numeric_limits<TimeNs>::min() : events.back().t_ns;
  const std::size_t before = events.size();
  events.resize(before + columns.t.size());
  const std::span<Event> block = std::span(events).subspan(before);
  if (make_events(columns, size, block) && (block.empty() || block.front().t_ns >= last_ns)) return;
  events.resize(before);
  report(columns, range.begin, size, last_ns);
}

EventH5Reader::EventH5Reader(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

EventH5Reader::~EventH5Reader() = default;
EventH5Reader::EventH5Reader(EventH5Reader&&) noexcept = default;
EventH5Reader& EventH5Reader::operator=(EventH5Reader&&) noexcept = default;

EventFileInfo EventH5Reader::info() const {
  const H5Lock lock;
  EventFileInfo info;
  info.count = state_->count;
  info.unit = state_->unit == 1 ? TimestampUnit::kNanoseconds : TimestampUnit::kMicroseconds;
  info.sensor = state_->sensor;
  if (info.count == 0) return info;
  const auto time_at = [&](std::uint64_t i) {
    return state_->time_ns(state_->read_times({i, i + 1}).front(), i);
  };
  info.first_ns = time_at(0);
  info.last_ns = time_at(info.count - 1);
  return info;
}

std::uint64_t EventH5Reader::block_events() const {
  // The library unpacks chunks of any length, and keeps few.
  if (!state_->packed) return kH5Block;
  constexpr std::uint64_t kLeast = std::uint64_t{1} << 18U;  // work for several threads
  const std::uint64_t chunk = state_->packed->longest_chunk();
  return (kLeast + chunk - 1) / chunk * chunk;
}

std::pair<std::uint64_t, std::uint64_t> EventH5Reader::range(TimeWindow window) const {
  const H5Lock lock;
  const EventRange range = state_->find(window);
  return {range.begin, range.end};
}

void EventH5Reader::append(std::uint64_t begin, std::uint64_t end, SensorSize size,
                           Events& events) const {
  // Blocks end at multiples of kH5Block, so that no chunk is unpacked twice.
  while (begin < end) {
    const std::uint64_t block_end = std::min(end, (begin / kH5Block + 1) * kH5Block);
    state_->append_block({begin, block_end}, size, events);
    begin = block_end;
  }
}

Events EventH5Reader::read(SensorSize size, TimeWindow window) const {
  const auto [begin, end] = range(window);
  Events events;
  events.reserve(end - begin);
  append(begin, end, size, events);
  sort_ties(events);
  return events;
}

}  // namespace saccade
