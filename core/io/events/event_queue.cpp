#include "core/io/events/event_queue.h"

#include <algorithm>

#include "core/check.h"
#include "core/stopwatch.h"

namespace saccade {

std::span<const Event> EventQueue::ahead(std::size_t count) {
  const ScopedTimer waiting(waited_s_);
  // A vector that grows by itself holds up to three times as much for a moment.
  const auto expected = static_cast<std::size_t>(expected_count_);
  if (count > events_.capacity()) events_.reserve(std::min(count, expected));
  while (!is_over_ && events_.size() - begin_ < count) {
    const std::span<const Event> next = stream_.next();
    is_over_ = next.empty();
    // What was dropped makes room before the memory grows.
    events_.erase(events_.begin(), events_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
    events_.insert(events_.end(), next.begin(), next.end());
  }
  return std::span(events_).subspan(begin_);
}

void EventQueue::drop(std::size_t count) {
  SACCADE_CHECK(count <= events_.size() - begin_);
  begin_ += count;
  dropped_ += count;
}

}  // namespace saccade
