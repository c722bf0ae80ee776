#include "core/io/events/tie_run.h"

#include <algorithm>

#include "core/check.h"

namespace saccade {

void TieRun::add(std::span<const Event> events) {
  if (events.empty()) return;
  if (empty()) t_ns_ = events.front().t_ns;
  std::vector<std::uint64_t> keys(events.size());
  std::transform(events.begin(), events.end(), keys.begin(), tie_key);
  std::sort(keys.begin(), keys.end());
  std::vector<Count> merged;
  merged.reserve(counts_.size() + keys.size());
  const auto append = [&](const Count& count) {
    if (merged.empty() || merged.back().key != count.key)
      merged.push_back(count);
    else
      merged.back().events += count.events;
  };
  auto known = counts_.begin();
  for (const std::uint64_t key : keys) {
    for (; known != counts_.end() && known->key <= key; ++known) append(*known);
    append({key, 1});
  }
  for (; known != counts_.end(); ++known) append(*known);
  merged.shrink_to_fit();
  counts_ = std::move(merged);
  size_ += events.size();
}

void TieRun::take(std::size_t most, std::vector<Event>& events) {
  SACCADE_CHECK(is_complete_);
  while (most > 0 && next_ < counts_.size()) {
    Count& count = counts_[next_];
    const std::size_t taken = std::min<std::uint64_t>(most, count.events);
    events.insert(events.end(), taken, event_of_tie_key(count.key, t_ns_));
    count.events -= taken;
    most -= taken;
    size_ -= taken;
    if (count.events == 0) ++next_;
  }
  if (next_ < counts_.size()) return;
  counts_.clear();
  next_ = 0;
  is_complete_ = false;
}

}  // namespace saccade
