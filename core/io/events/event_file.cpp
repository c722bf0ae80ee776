#include "core/io/events/event_file.h"

#include <algorithm>

#include "core/io/events/events_h5.h"
#include "core/io/events/events_text.h"

namespace saccade {
namespace {

bool is_h5(const std::filesystem::path& file) {
  return file.extension() == ".h5" || file.extension() == ".hdf5";
}

}  // namespace

Events read_events(const std::filesystem::path& file, SensorSize size, TimeWindow window) {
  if (is_h5(file)) return EventH5Reader(file).read(size, window);
  return read_events_text(file, size, window);
}

EventFileInfo read_event_file_info(const std::filesystem::path& file) {
  return is_h5(file) ? EventH5Reader(file).info() : read_events_text_info(file);
}

std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                               TimestampUnit unit, SensorSize sensor) {
  if (is_h5(file)) return std::make_unique<EventH5Writer>(file, unit, sensor);
  return std::make_unique<EventTextWriter>(file);
}

SensorSize stated_sensor(const std::filesystem::path& file) {
  return is_h5(file) ? EventH5Reader(file).info().sensor : SensorSize{};
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
