#include "core/io/events/rounded_events.h"

#include <utility>

#include "core/check.h"

namespace saccade {

void RoundedEvents::add(std::span<const Event> events) {
  for (Event event : events) {
    SACCADE_CHECK(event.t_ns >= last_);
    last_ = event.t_ns;
    if (unit_ > 1) event.t_ns = floor_div(event.t_ns + 500, 1000) * 1000;
    add_rounded(event);
  }
}

void RoundedEvents::add_rounded(const Event& event) {
  if (run_.is_complete()) {
    later_.push_back(event);
    return;
  }
  const bool is_tie = pending_.size() > open_ties_ ? pending_.back().t_ns == event.t_ns
                                                   : !run_.empty() && run_.t_ns() == event.t_ns;
  if (!is_tie) close_run();
  if (run_.is_complete()) {
    later_.push_back(event);
    return;
  }
  pending_.push_back(event);
  if (pending_.size() - open_ties_ > TieRun::kMostHeld) count_open_ties();
}

void RoundedEvents::count_open_ties() {
  run_.add(std::span(pending_).subspan(open_ties_));
  pending_.resize(open_ties_);
}

void RoundedEvents::finish() {
  is_finished_ = true;
  close_run();
}

/// The last run of equal times will not go on.
void RoundedEvents::close_run() {
  if (run_.is_complete()) return;
  if (!run_.empty()) {
    count_open_ties();
    run_.complete();
    return refill();
  }
  sort_ties(std::span(pending_).subspan(open_ties_));
  open_ties_ = pending_.size();
}

void RoundedEvents::refill() {
  if (!run_.is_complete() || pending_.size() >= kLeast) return;
  run_.take(kLeast - pending_.size(), pending_);
  open_ties_ = pending_.size();
  if (!run_.empty()) return;
  for (const Event& event : std::exchange(later_, {})) add_rounded(event);
  if (is_finished_) close_run();
}

void RoundedEvents::drop(std::size_t count) {
  SACCADE_CHECK(count <= open_ties_);
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
  open_ties_ -= count;
  refill();
}

}  // namespace saccade
