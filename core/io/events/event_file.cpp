#include "core/io/events/event_file.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/io/events/event_formats.h"
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

EventStream::EventStream(const std::filesystem::path& file, SensorSize size, TimeWindow window)
    : reader_(open_reader(file, size, window)), window_(window) {}

std::span<const Event> EventStream::next() {
  events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(given_));
  given_ = 0;
  if (!run_.empty()) return next_of_run();
  while (given_ == 0) {
    is_over_ = is_over_ || !read_within(*reader_, window_, events_);
    // The last run of equal times may go on in the next block.
    given_ = events_.size();
    if (is_over_) break;
    const TimeNs last_ns = events_.back().t_ns;
    while (given_ > 0 && events_[given_ - 1].t_ns == last_ns) --given_;
    if (given_ == 0 && events_.size() > TieRun::kMostHeld) return next_of_run();
  }
  const std::span<Event> complete = std::span(events_).first(given_);
  sort_ties(complete);
  return complete;
}

/// A run of equal times that fills the memory is counted rather than held: first all of it is read,
/// then it is given out block by block. It stands at the front of events_.
std::span<const Event> EventStream::next_of_run() {
  if (!run_.is_complete()) {
    const TimeNs t_ns = events_.front().t_ns;
    while (true) {
      const auto end = std::find_if(events_.begin(), events_.end(),
                                    [&](const Event& event) { return event.t_ns != t_ns; });
      run_.add({events_.begin(), end});
      events_.erase(events_.begin(), end);
      if (!events_.empty() || is_over_) break;
      is_over_ = !read_within(*reader_, window_, events_);
    }
    run_.complete();
  }
  run_events_.clear();
  run_.take(kEventBlock, run_events_);
  return run_events_;
}

std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                               TimestampUnit unit, SensorSize sensor) {
  const EventFormat* format = find_written_format(file);
  if (format == nullptr) format = &*std::rbegin(event_formats());
  return format->make_writer(file, unit, sensor);
}

void sort_ties(std::span<Event> events) {
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

}  // namespace saccade
