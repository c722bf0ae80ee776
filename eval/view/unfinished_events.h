#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "core/event.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// Appends the events that a program which is still recording has written since the last call.
using EventTail = std::function<void(Events&)>;
/// The tail of what grows in a hidden folder.
using EventTailOf = std::function<EventTail(const std::filesystem::path& hidden)>;

/// The newest events of a recording in the making, at most kMostUnfinishedEvents. Thread-safe.
class UnfinishedEvents {
 public:
  explicit UnfinishedEvents(EventTail tail);

  /// Takes what came since the last call.
  void refresh();
  /// Time of the newest event [us]; nullopt before the first.
  [[nodiscard]] std::optional<std::int64_t> reached_us() const;
  /// Of the smallest sensor that holds all events so far [px].
  [[nodiscard]] SensorSize size() const;
  /// EventPacker's bytes of those of [start_us, end_us) that are held.
  [[nodiscard]] std::string pack(std::int64_t start_us, std::int64_t end_us) const;

 private:
  mutable std::mutex mutex_;
  EventTail tail_;
  Events newest_;
  SensorSize size_;
};

constexpr std::size_t kMostUnfinishedEvents = 1'000'000;

}  // namespace saccade
