#include "core/io/events/event_file.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/events/tie_run.h"
#include "core/process/background_task.h"
#include "core/process/parallel.h"
#include "core/time_search.h"

namespace saccade {
namespace {

std::unique_ptr<EventReader> open_reader(const std::filesystem::path& file, SensorSize size,
                                         TimeWindow window) {
  return recognise_event_format(file).open(file, size, window);
}

/// Reads the next block that reaches into the window, without what lies outside of it; false where
/// there is none.
bool read_within(EventReader& reader, TimeWindow window, Events& events) {
  const auto before = static_cast<std::ptrdiff_t>(events.size());
  while (reader.read(events)) {
    const auto begin = events.begin() + before;
    const std::span<const Event> block(begin, events.end());
    if (block.empty()) continue;
    const bool is_beyond = block.back().t_ns >= window.end_ns;
    if (!window.is_everything()) {
      const auto end = static_cast<std::ptrdiff_t>(count_before(block, window.end_ns));
      const auto start = static_cast<std::ptrdiff_t>(count_before(block, window.start_ns));
      events.erase(begin + std::max(start, end), events.end());
      events.erase(begin, begin + start);
    }
    if (events.end() - events.begin() > before) return true;
    if (is_beyond) return false;
  }
  return false;
}

/// Sorts events of the same time, by their keys: several times as fast as event by event.
void sort_run(std::span<Event> events, std::vector<std::uint64_t>& keys) {
  keys.resize(events.size());
  std::transform(events.begin(), events.end(), keys.begin(), tie_key);
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < events.size(); ++i)
    events[i] = event_of_tie_key(keys[i], events[i].t_ns);
}

/// The ties of whole runs of equal time.
void sort_part(std::span<Event> events) {
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const TimeNs t_ns = events[i].t_ns;
    if (t_ns != events[i - 1].t_ns || tie_key(events[i - 1]) <= tie_key(events[i])) continue;
    std::size_t begin = i - 1;
    while (begin > 0 && events[begin - 1].t_ns == t_ns) --begin;
    while (i < events.size() && events[i].t_ns == t_ns) ++i;
    if (i - begin == 2)
      std::swap(events[begin], events[begin + 1]);
    else
      sort_run(events.subspan(begin, i - begin), keys);
  }
}

}  // namespace

Events read_events(const std::filesystem::path& file, SensorSize size, TimeWindow window) {
  const std::unique_ptr<EventReader> reader = open_reader(file, size, window);
  Events events;
  events.reserve(reader->expected_count());
  while (read_within(*reader, window, events)) {
  }
  sort_ties(events);
  return events;
}

EventFileInfo read_event_file_info(const std::filesystem::path& file) {
  const EventFormat& format = recognise_event_format(file);
  if (format.read_info != nullptr) return format.read_info(file);
  EventStream stream(file);
  EventFileInfo info;
  info.unit = stream.unit();
  info.sensor = stream.sensor();
  while (true) {
    const std::span<const Event> events = stream.next();
    if (events.empty()) return info;
    if (info.count == 0) info.first_ns = events.front().t_ns;
    info.last_ns = events.back().t_ns;
    info.count += events.size();
  }
}

SensorSize stated_sensor(const std::filesystem::path& file) {
  const EventFormat& format = recognise_event_format(file);
  return format.states_sensor ? format.open(file, {}, {})->sensor() : SensorSize{};
}

std::optional<TimeNs> first_event_ns(const std::filesystem::path& file) {
  if (const EventFormat& format = recognise_event_format(file); format.read_info != nullptr) {
    const EventFileInfo info = format.read_info(file);
    return info.count == 0 ? std::nullopt : std::optional(info.first_ns);
  }
  const std::unique_ptr<EventReader> reader = open_reader(file, {}, {});
  Events events;
  while (events.empty() && reader->read(events)) {
  }
  return events.empty() ? std::nullopt : std::optional(events.front().t_ns);
}

struct EventStream::State {
  State(const std::filesystem::path& file, SensorSize size, TimeWindow time_window)
      : reader(open_reader(file, size, time_window)), window(time_window) {}

  void read_block();
  void take_run();

  // All of this belongs to `reading` until it has been waited for.
  std::unique_ptr<EventReader> reader;
  TimeWindow window;
  Events block;  ///< the next events to be given out
  Events begun;  ///< the last ones that were read: of one time, which may go on
  bool is_over = false;
  TieRun run;               ///< of equal times, that is too long to be held
  Events used;              ///< given out by the last next()
  bool is_reading = false;  ///< whether a block was asked for
  BackgroundTask reading;   ///< of `block`; last, so that it ends before the rest does
};

EventStream::EventStream(const std::filesystem::path& file, SensorSize size, TimeWindow window)
    : state_(std::make_unique<State>(file, size, window)) {}

EventStream::~EventStream() = default;
EventStream::EventStream(EventStream&&) noexcept = default;
EventStream& EventStream::operator=(EventStream&&) noexcept = default;

std::span<const Event> EventStream::next() {
  State& state = *state_;
  if (!state.is_reading) state.reading.start([&state] { state.read_block(); });
  state.is_reading = false;
  state.reading.wait();
  std::swap(state.used, state.block);
  if (state.used.empty()) return {};
  state.reading.start([&state] { state.read_block(); });
  state.is_reading = true;
  return state.used;
}

SensorSize EventStream::sensor() const {
  state_->reading.settle();
  return state_->reader->sensor();
}

TimestampUnit EventStream::unit() const {
  state_->reading.settle();
  return state_->reader->unit();
}

std::uint64_t EventStream::expected_count() const {
  state_->reading.settle();
  return state_->reader->expected_count();
}

/// Fills the block with complete runs of equal time; it stays empty at the end.
void EventStream::State::read_block() {
  block.clear();
  if (!run.empty()) return run.take(kEventBlock, block);
  std::swap(block, begun);
  while (!is_over) {
    is_over = !read_within(*reader, window, block);
    if (is_over) break;
    // The last run of equal times may go on in the next block.
    const TimeNs last_ns = block.back().t_ns;
    auto end = block.end();
    while (end != block.begin() && std::prev(end)->t_ns == last_ns) --end;
    if (end == block.begin()) {
      if (block.size() > TieRun::kMostHeld) return take_run();
      continue;
    }
    begun.assign(end, block.end());
    block.erase(end, block.end());
    break;
  }
  sort_ties(block);
}

/// A run of equal times that fills the memory is counted rather than held: first all of it is read,
/// then it is given out block by block.
void EventStream::State::take_run() {
  const TimeNs t_ns = block.front().t_ns;
  while (true) {
    const auto end = std::find_if(block.begin(), block.end(),
                                  [&](const Event& event) { return event.t_ns != t_ns; });
    run.add({block.begin(), end});
    block.erase(block.begin(), end);
    if (!block.empty() || is_over) break;
    is_over = !read_within(*reader, window, block);
  }
  run.complete();
  std::swap(begun, block);
  block.clear();
  run.take(kEventBlock, block);
}

std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                               TimestampUnit unit, SensorSize sensor) {
  const EventFormat* format = find_written_format(file);
  if (format == nullptr) format = &*std::rbegin(event_formats());
  return format->make_writer(file, unit, sensor);
}

void sort_ties(std::span<Event> events) {
  // The first of its time at or after a multiple of the grain, where the parts are divided.
  constexpr std::size_t kSortedTogether = std::size_t{1} << 16U;
  const auto divide = [&](std::size_t i) {
    while (i > 0 && i < events.size() && events[i].t_ns == events[i - 1].t_ns) ++i;
    return i;
  };
  std::vector<std::size_t> ends;
  for (std::size_t i = kSortedTogether; i < events.size(); i += kSortedTogether)
    if (ends.empty() || ends.back() < i) ends.push_back(divide(i));
  ends.push_back(events.size());
  parallel_for(ends.size(), [&](std::size_t i) {
    const std::size_t begin = i > 0 ? ends[i - 1] : 0;
    sort_part(events.subspan(begin, ends[i] - begin));
  });
}

}  // namespace saccade
