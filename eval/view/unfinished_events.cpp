#include "eval/view/unfinished_events.h"

#include <algorithm>
#include <utility>

#include "core/time_search.h"
#include "eval/view/event_windows.h"

namespace saccade {

UnfinishedEvents::UnfinishedEvents(EventTail tail) : tail_(std::move(tail)) {}

void UnfinishedEvents::refresh() {
  const std::lock_guard lock(mutex_);
  Events fresh;
  tail_(fresh);
  if (fresh.empty()) return;
  for (const Event& event : fresh) {
    size_.width = std::max(size_.width, event.x + 1);
    size_.height = std::max(size_.height, event.y + 1);
  }
  // A recording that began anew.
  if (!newest_.empty() && fresh.front().t_ns < newest_.back().t_ns) newest_.clear();
  newest_.insert(newest_.end(), fresh.begin(), fresh.end());
  if (newest_.size() > kMostUnfinishedEvents)
    newest_.erase(newest_.begin(),
                  newest_.end() - static_cast<std::ptrdiff_t>(kMostUnfinishedEvents));
}

std::optional<std::int64_t> UnfinishedEvents::reached_us() const {
  const std::lock_guard lock(mutex_);
  if (newest_.empty()) return std::nullopt;
  return newest_.back().t_ns / kNsPerUs;
}

SensorSize UnfinishedEvents::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

std::string UnfinishedEvents::pack(std::int64_t start_us, std::int64_t end_us) const {
  const std::lock_guard lock(mutex_);
  EventPacker packer(start_us);
  for (const Event& event : events_between(newest_, start_us * kNsPerUs, end_us * kNsPerUs))
    packer.add(event);
  return packer.bytes(1);
}

}  // namespace saccade
