#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "core/io/events/event_file.h"
#include "core/io/events/event_formats.h"

namespace saccade {

/// Lines `t x y p` (Event Camera Dataset): seconds, column, row, polarity 1/0 or 1/-1. Times become
/// integer ns digit by digit, hence exactly. InputError with `file:line` for malformed lines, times
/// that go back and coordinates outside `size`. Lines outside `window` are checked for their time
/// only; reading stops at its end.
[[nodiscard]] std::unique_ptr<EventReader> open_events_text(const std::filesystem::path& file,
                                                            SensorSize size, TimeWindow window);
/// Likewise of events.txt in a zip archive, as the Event Camera Dataset is published, without
/// unpacking it to disk.
[[nodiscard]] std::unique_ptr<EventReader> open_events_zip(const std::filesystem::path& archive,
                                                           SensorSize size, TimeWindow window);
/// Whether a zip archive holds an events.txt.
[[nodiscard]] bool is_events_zip(const EventFileHead& head);

/// Writes lines `t x y p` with 9 decimals and p = 0/1, so that reading gives the same events.
class EventTextWriter final : public EventWriter {
 public:
  explicit EventTextWriter(const std::filesystem::path& file);
  ~EventTextWriter() override;
  void append(std::span<const Event> events) override;
  void close() override;
  [[nodiscard]] std::uint64_t count() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
