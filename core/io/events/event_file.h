#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>

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

  [[nodiscard]] bool is_everything() const {
    return start_ns == TimeWindow().start_ns && end_ns == TimeWindow().end_ns;
  }
};

/// What a file holds.
struct EventFileInfo {
  std::uint64_t count = 0;
  TimeNs first_ns = 0;  ///< 0 when there are no events
  TimeNs last_ns = 0;
  TimestampUnit unit = TimestampUnit::kNanoseconds;
  SensorSize sensor;  ///< where the format states it (EventFormat::states_sensor)
};

/// Events of a file in EventOrder. Its format is recognised by its content (event_formats.h). The
/// file must be in order of time, ties are sorted here. Throws InputError with line, byte or index
/// for everything malformed, coordinates outside `size` included.
[[nodiscard]] Events read_events(const std::filesystem::path& file, SensorSize size,
                                 TimeWindow window = {});
/// Without reading all of the file where its format allows that, else in memory of fixed size.
[[nodiscard]] EventFileInfo read_event_file_info(const std::filesystem::path& file);
/// The sensor's size where the file states it; no event is read.
[[nodiscard]] SensorSize stated_sensor(const std::filesystem::path& file);

/// One file that is being read, block by block: what a format implements (event_formats.h). It
/// checks what it reads as read_events() says; those of equal time may be in any order.
class EventReader {
 public:
  virtual ~EventReader() = default;
  /// Appends the next events, about kEventBlock at a time; false where there were none left.
  virtual bool read(Events& events) = 0;
  /// Of the whole file; 0 where it is not stated.
  [[nodiscard]] virtual SensorSize sensor() const { return {}; }
  [[nodiscard]] virtual TimestampUnit unit() const { return TimestampUnit::kMicroseconds; }
  /// About how many events read() will give, for which memory is reserved; 0: unknown. To be
  /// estimated by the size of the file rather than by what it claims.
  [[nodiscard]] virtual std::uint64_t expected_count() const { return 0; }
};

constexpr std::size_t kEventBlock = std::size_t{1} << 16U;

/// The events of a file as read_events() gives them, block by block: memory does not grow with the
/// file. While one block is used the next one is read, on the threads of parallel_for(); an error in it
/// is thrown when its turn comes.
class EventStream {
 public:
  explicit EventStream(const std::filesystem::path& file, SensorSize size = {},
                       TimeWindow window = {});
  ~EventStream();
  EventStream(EventStream&&) noexcept;
  EventStream& operator=(EventStream&&) noexcept;

  /// The next events, valid until the next call; none at the end. Those of equal time come
  /// together, unless there are more than TieRun::kMostHeld: then in several calls, still in EventOrder.
  [[nodiscard]] std::span<const Event> next();
  [[nodiscard]] SensorSize sensor() const;
  [[nodiscard]] TimestampUnit unit() const;
  /// About how many events there are; 0: unknown. Before the first next().
  [[nodiscard]] std::uint64_t expected_count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Time of the first event of the file [ns]; nullopt where there is none. Reads no more than a block.
[[nodiscard]] std::optional<TimeNs> first_event_ns(const std::filesystem::path& file);

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

/// The writer for the file's ending; text for endings that event_formats() does not hold. `unit`
/// and `sensor` matter only to formats that store them.
[[nodiscard]] std::unique_ptr<EventWriter> make_event_writer(const std::filesystem::path& file,
                                                             TimestampUnit unit,
                                                             SensorSize sensor = {});

/// Sorts runs of equal time by EventOrder, in parallel; `events` are in order of time.
void sort_ties(std::span<Event> events);

}  // namespace saccade
