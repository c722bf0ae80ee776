#include "core/io/events/rounded_events.h"

#include "core/check.h"

namespace saccade {

void RoundedEvents::add(std::span<const Event> events) {
  for (Event event : events) {
    SACCADE_CHECK(event.t_ns >= last_);
    last_ = event.t_ns;
    if (unit_ > 1) event.t_ns = floor_div(event.t_ns + 500, 1000) * 1000;
    if (!pending_.empty() && pending_.back().t_ns != event.t_ns) finish();
    pending_.push_back(event);
  }
}

void RoundedEvents::finish() {
  sort_ties(std::span(pending_).subspan(open_ties_));
  open_ties_ = pending_.size();
}

void RoundedEvents::drop(std::size_t count) {
  SACCADE_CHECK(count <= open_ties_);
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
  open_ties_ -= count;
}

}  // namespace saccade
