#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "core/io/events/event_file.h"

namespace saccade {

/// The events of a stream for somebody who takes them from the front, and sees as many ahead as he needs
/// for that: the memory is that of what he sees.
class EventQueue {
 public:
  explicit EventQueue(EventStream stream)
      : stream_(std::move(stream)), expected_count_(stream_.expected_count()) {}

  /// About how many events there are in all; 0: unknown.
  [[nodiscard]] std::uint64_t expected_count() const { return expected_count_; }

  /// Those that were not dropped, at least `count` of them unless the stream ends before; valid until the
  /// next call. Whole runs of equal time, but for those that are too long (EventStream::next()).
  [[nodiscard]] std::span<const Event> ahead(std::size_t count);
  /// Removes the first ones of ahead().
  void drop(std::size_t count);
  /// Those that were dropped.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// Whether the last ahead() gave everything that is left.
  [[nodiscard]] bool is_complete() const { return is_over_; }
  /// Time that was spent on reading rather than on what is done with the events [s].
  [[nodiscard]] double waited_s() const { return waited_s_; }

 private:
  EventStream stream_;
  std::uint64_t expected_count_;
  Events events_;
  std::size_t begin_ = 0;  ///< of those that were not dropped
  std::uint64_t dropped_ = 0;
  bool is_over_ = false;
  double waited_s_ = 0;
};

}  // namespace saccade
