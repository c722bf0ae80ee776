#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "core/io/events/event_file.h"

namespace saccade {

/// Events of HDF5 files. Where the path names no member ("FILE!/prophesee/right"), they are looked for
/// in /events (the layout of DSEC and TUM-VIE, below), /CD/events (Prophesee: a table of x, y, p and
/// t [us]; attribute "geometry" of the file), /prophesee/left (M3ED: columns x, y, p and t [us]),
/// /davis/left/events (MVSEC: a matrix of double precision with rows x, y, t [s] and p), and in the
/// columns /x, /y, /p and /t [us] (e2calib). Polarities are 1 for ON, and 0 or -1 for OFF.
///
/// The DSEC layout: /events/x and y (u16), /events/p (0/1), /events/t (integers,
/// attribute "unit" = "us" or "ns", us without it), /ms_to_idx (index of the first event at or
/// after each millisecond) and /t_offset, which is added to all times. Beside the layout the group
/// may state the sensor's size, attributes "width" and "height" [px]. Opening checks types and
/// lengths.
class EventH5Reader {
 public:
  explicit EventH5Reader(const std::filesystem::path& file);
  ~EventH5Reader();
  EventH5Reader(EventH5Reader&&) noexcept;
  EventH5Reader& operator=(EventH5Reader&&) noexcept;

  [[nodiscard]] EventFileInfo info() const;
  /// So many events are best read at once: whole chunks, so that none is unpacked twice, and no more
  /// than stay in the caches.
  [[nodiscard]] std::uint64_t block_events() const;
  /// Indices [first, second) of the window's events.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> range(TimeWindow window) const;
  /// Events of the window in EventOrder; reads only the chunks that hold them. InputError with the
  /// place `file:/events/t[INDEX]` for times that go back, polarities other than 0/1, coordinates
  /// outside `size`, an index that contradicts the times, and chunks that cannot be read.
  [[nodiscard]] Events read(SensorSize size, TimeWindow window = {}) const;
  /// Appends the events of indices [begin, end), with the same checks but for ties, which stay as
  /// they are.
  void append(std::uint64_t begin, std::uint64_t end, SensorSize size, Events& events) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The window's events, block by block.
[[nodiscard]] std::unique_ptr<EventReader> open_events_h5(const std::filesystem::path& file,
                                                          SensorSize size, TimeWindow window);

/// Writes the layout above; chunks are shuffled and deflated (level 1) in parallel, the bytes do
/// not depend on the number of threads. With TimestampUnit::kMicroseconds times are rounded to the
/// nearest microsecond and ties that this creates are sorted by EventOrder. Times count from 0
/// (/t_offset = 0) where the first one is within the first hour, else from the whole second before
/// it.
class EventH5Writer final : public EventWriter {
 public:
  /// `sensor`: 0 is not stated.
  EventH5Writer(const std::filesystem::path& file, TimestampUnit unit, SensorSize sensor = {});
  ~EventH5Writer() override;
  void append(std::span<const Event> events) override;
  void close() override;
  [[nodiscard]] std::uint64_t count() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
