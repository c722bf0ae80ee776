#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/io/events/event_file.h"
#include "core/io/events/events_h5.h"
#include "core/io/files/scratch_folder.h"

namespace saccade {

inline constexpr TimeNs kNsPerUs = 1000;

/// Windows of a recording's events, read when they are asked for: memory does not grow with the
/// recording. HDF5 is read where it lies. Files of other formats cannot be read from their middle:
/// they are copied once, block by block, into HDF5 in a temporary folder that goes with the object,
/// when something is asked for the first time. Thread-safe. Throws InputError as read_events() does.
class EventWindows {
 public:
  /// Opens nothing yet. `size`: of the sensor, which coordinates are checked against.
  EventWindows(std::filesystem::path file, SensorSize size);

  [[nodiscard]] EventFileInfo info() const;
  [[nodiscard]] std::uint64_t count(TimeWindow window) const;
  /// Calls `use` with every event of the window in order of time and its index in the recording.
  void visit(TimeWindow window,
             const std::function<void(std::uint64_t index, const Event&)>& use) const;

 private:
  [[nodiscard]] const EventH5Reader& reader() const;

  std::filesystem::path file_;
  SensorSize size_;
  mutable std::mutex mutex_;  ///< of the following, until they are there
  mutable std::optional<ScratchFolder> copy_;
  mutable std::unique_ptr<const EventH5Reader> reader_;
};

/// Events of a window as a page draws them, little-endian:
///   u32 number n, u32 stride, n x u32 time since the window's start [us], n x u16 column with the
///   highest bit set for OFF, n x u16 row.
class EventPacker {
 public:
  explicit EventPacker(std::int64_t start_us);
  /// Not before the start and at most kLongestPacked_us after it (contract). InputError for a
  /// column beyond 32767.
  void add(const Event& event);
  /// `stride`: of how many events of the recording each stands for.
  [[nodiscard]] std::string bytes(std::uint32_t stride) const;

 private:
  TimeNs start_ns_;
  std::vector<std::uint32_t> times_;
  std::vector<std::uint16_t> columns_, rows_;
};

constexpr std::uint64_t kMostPackedEvents = 2'000'000;
constexpr std::int64_t kLongestPacked_us = 4'000'000'000;

/// Of the recording's events in [start_us, end_us) those whose index `every` divides, and a multiple
/// of it where more than kMostPackedEvents would be left: the stride. The window is at most
/// kLongestPacked_us long (contract).
[[nodiscard]] std::string pack_events(const EventWindows& events, std::int64_t start_us,
                                      std::int64_t end_us, std::uint64_t every = 1);

}  // namespace saccade
