#include "core/io/events/event_file.h"

#include <algorithm>
#include <iterator>

#include "core/io/events/events_h5.h"
#include "core/io/events/events_text.h"

namespace saccade {
namespace {

std::unique_ptr<EventWriter> make_h5(const std::filesystem::path& file, TimestampUnit unit,
                                     SensorSize sensor) {
  return std::make_unique<EventH5Writer>(file, unit, sensor);
}

Events read_h5(const std::filesystem::path& file, SensorSize size, TimeWindow window) {
  return EventH5Reader(file).read(size, window);
}

EventFileInfo read_h5_info(const std::filesystem::path& file) { return EventH5Reader(file).info(); }

std::unique_ptr<EventWriter> make_text(const std::filesystem::path& file, TimestampUnit /*unit*/,
                                       SensorSize /*sensor*/) {
  return std::make_unique<EventTextWriter>(file);
}

constexpr EventFormat kEventFormats[] = {
    {.ending = ".h5",
     .help = "HDF5 in the layout of DSEC.",
     .states_sensor = true,
     .read = read_h5,
     .read_info = read_h5_info,
     .make_writer = make_h5},
    {.ending = ".hdf5",
     .help = "The same.",
     .states_sensor = true,
     .read = read_h5,
     .read_info = read_h5_info,
     .make_writer = make_h5},
    {.ending = ".txt",
     .help = "Text lines t x y p, t in seconds.",
     .states_sensor = false,
     .read = read_events_text,
     .read_info = read_events_text_info,
     .make_writer = make_text},
};

/// The row of the file's ending; text, the last row, where the table does not hold it.
const EventFormat& format_of(const std::filesystem::path& file) {
  const EventFormat* format = find_event_format(file);
  return format != nullptr ? *format : *std::rbegin(kEventFormats);
}

}  // namespace

std::span<const EventFormat> event_formats() { return kEventFormats; }

std::string event_file_names() {
  std::string names;
  for (const EventFormat& format : kEventFormats)
    names.append(names.empty() ? "" : ", ").append("events").append(format.ending);
  return names;
}

const EventFormat* find_event_format(const std::filesystem::path& file) {
  for (const EventFormat& format : kEventFormats)
    if (file.extension() == format.ending) return &format;
  return nullptr;
}

Events read_events(const std::filesystem::path& file, SensorSize size, TimeWindow window) {
  return format_of(file).read(file, size, window);
}

EventFileInfo read_event_file_info(const std::filesystem::path& file) {
  return format_of(file).read_info(file);
}

std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                               TimestampUnit unit, SensorSize sensor) {
  return format_of(file).make_writer(file, unit, sensor);
}

SensorSize stated_sensor(const std::filesystem::path& file) {
  const EventFormat& format = format_of(file);
  return format.states_sensor ? format.read_info(file).sensor : SensorSize{};
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
