#include "estimator/tracking/edges/event_window.h"

#include <algorithm>

#include "core/check.h"
#include "estimator/mean_time.h"

namespace saccade {

void EventWindow::start(std::span<const Event> stream) {
  stream_ = stream;
  begin_ = end_ = last_begin_ = last_end_ = 0;
  sum_ = 0;
}

bool EventWindow::advance(std::size_t count) {
  SACCADE_CHECK(count > 0);
  const bool slides = options_.window == EventFrameOptions::Window::kSliding;
  std::size_t fresh = count;
  if (slides && end_ > 0)
    fresh = std::max<std::size_t>(
        1, static_cast<std::size_t>(options_.new_fraction * static_cast<double>(count)));
  if (stream_.size() - end_ < fresh) return false;
  last_begin_ = begin_;
  last_end_ = end_;
  end_ += fresh;
  begin_ = std::max(begin_, end_ - std::min(end_, count));
  if (slides) {
    const TimeNs origin = stream_.front().t_ns;
    for (const Event& e : entered()) sum_ += e.t_ns - origin;
    for (const Event& e : left()) sum_ -= e.t_ns - origin;
  }
  return true;
}

std::span<const Event> EventWindow::events() const {
  return stream_.subspan(begin_, end_ - begin_);
}

std::span<const Event> EventWindow::newest(std::size_t count) const {
  count = std::min(count, end_);
  return stream_.subspan(end_ - count, count);
}

std::span<const Event> EventWindow::entered() const {
  return stream_.subspan(last_end_, end_ - last_end_);
}

std::span<const Event> EventWindow::left() const {
  return stream_.subspan(last_begin_, begin_ - last_begin_);
}

double EventWindow::new_fraction() const {
  return static_cast<double>(entered().size()) / static_cast<double>(events().size());
}

TimeNs EventWindow::mean_time() const {
  if (options_.window == EventFrameOptions::Window::kDisjoint) return saccade::mean_time(events());
  return stream_.front().t_ns + sum_ / static_cast<TimeNs>(end_ - begin_);
}

}  // namespace saccade
