#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/event.h"

namespace saccade {

/// Sensor size that coordinates are checked against [px]; 0 = unknown, not checked.
struct SensorSize {
  int width = 0;
  int height = 0;
};

/// Unit of integer times in a file; in memory they are always ns.
enum class TimestampUnit { kMicroseconds, kNanoseconds };

/// Half-open window start <= t < end [ns].
struct TimeWindow {
  TimeNs start_ns = std::numeric_limits<TimeNs>::min();
  TimeNs end_ns = std::numeric_limits<TimeNs>::max();
};

/// What a file holds, without reading all of it where the format allows that.
struct EventFileInfo {
  std::uint64_t count = 0;
  TimeNs first_ns = 0;  ///< 0 when there are no events
  TimeNs last_ns = 0;
  TimestampUnit unit = TimestampUnit::kNanoseconds;
  SensorSize sensor;  ///< where the format states it (EventFormat::states_sensor)
};

/// Events of a file in the format of its ending (event_formats(); any other ending: text), in
/// EventOrder: the file must be in order of time, ties are sorted here. Throws
/// InputError with line or index for everything malformed, coordinates outside `size` included.
[[nodiscard]] Events read_events(const std::filesystem::path& file, SensorSize size,
                                 TimeWindow window = {});
[[nodiscard]] EventFileInfo read_event_file_info(const std::filesystem::path& file);

/// Writes a stream of events in order of time, span by span. Nothing stands under the final name
/// before close(); without it everything is discarded.
class EventWriter {
 public:
  virtual ~EventWriter() = default;
  /// `events` ordered by time and not earlier than those appended before (contract).
  virtual void append(std::span<const Event> events) = 0;
  virtual void close() = 0;
  [[nodiscard]] virtual std::uint64_t count() const = 0;
};

/// The writer for the file's ending, as read_events() chooses; `unit` and `sensor` matter only to
/// formats that store them.
[[nodiscard]] std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                                             TimestampUnit unit,
                                                             SensorSize sensor = {});

/// A row of the table of formats. A new format is a reader and a writer beside this file and a row
/// in event_file.cpp; datasets, adapters and `saccade convert` read the table.
struct EventFormat {
  std::string_view ending;  ///< with its dot
  std::string_view help;    ///< a sentence: what such a file holds
  bool states_sensor;       ///< EventFileInfo::sensor
  Events (*read)(const std::filesystem::path&, SensorSize, TimeWindow);
  EventFileInfo (*read_info)(const std::filesystem::path&);
  std::unique_ptr<EventWriter> (*make_writer)(const std::filesystem::path&, TimestampUnit,
                                              SensorSize);
};

[[nodiscard]] std::span<const EventFormat> event_formats();
/// What the events of a dataset folder are called: "events.h5, events.txt", in the table's order.
[[nodiscard]] std::string event_file_names();
/// The row of the file's ending; nullptr where the table does not hold it.
[[nodiscard]] const EventFormat* find_event_format(const std::filesystem::path& file);

/// The sensor's size where the file states it; no event is read.
[[nodiscard]] SensorSize stated_sensor(const std::filesystem::path& file);

/// Sorts runs of equal time by EventOrder; `events` are in order of time.
void sort_ties(std::span<Event> events);

}  // namespace saccade
