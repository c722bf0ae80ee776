#include "core/io/events/event_file.h"

#include <algorithm>
#include <iterator>

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
  while (given_ == 0) {
    is_over_ = is_over_ || !read_within(*reader_, window_, events_);
    // The last run of equal times may go on in the next block.
    given_ = events_.size();
    if (is_over_) break;
    const TimeNs last_ns = events_.back().t_ns;
    while (given_ > 0 && events_[given_ - 1].t_ns == last_ns) --given_;
  }
  const std::span<Event> complete = std::span(events_).first(given_);
  sort_ties(complete);
  return complete;
}

std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                               TimestampUnit unit, SensorSize sensor) {
  const EventFormat* format = find_written_format(file);
  if (format == nullptr) format = &*std::rbegin(event_formats());
  return format->make_writer(file, unit, sensor);
}

void sort_ties(std::span<Event> events) {
  for (std::size_t begin = 0; begin < events.size();) {
    std::size_t end = begin + 1;
    bool sorted = true;
    for (; end < events.size() && events[end].t_ns == events[begin].t_ns; ++end)
      sorted = sorted && !EventOrder()(events[end], events[end - 1]);
    if (!sorted)
      std::sort(events.begin() + static_cast<std::ptrdiff_t>(begin),
                events.begin() + static_cast<std::ptrdiff_t>(end), EventOrder());
    begin = end;
  }
}

}  // namespace saccade
