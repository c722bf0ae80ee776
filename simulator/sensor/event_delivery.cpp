#include "simulator/sensor/event_delivery.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {

EventDelivery::EventDelivery(const EventOptions& options, const PinholeCamera& camera,
                             std::uint64_t seed)
    : step_ns_(options.timestamp_step_ns()),
      output_(options.noise, options.log_eps, camera.width, camera.height, step_ns_, seed) {}

void EventDelivery::deliver(double t_s, bool is_last, const Sink& sink) {
  if (is_last) {
    // The recording is half open: a camera that comes to its start again at the very end meets its
    // first thresholds exactly, and the last bit of rounding may not decide whether it fires.
    const auto end_ns = std::llround(t_s * 1e9 / static_cast<double>(step_ns_)) * step_ns_;
    std::erase_if(pending_, [&](const SensedEvent& event) { return event.t_ns >= end_ns; });
  }
  std::sort(pending_.begin(), pending_.end(), SensedEventOrder());
  // Rounding can put a later event on the tick of t_s or on the one before it.
  const TimeNs complete_ns =
      is_last ? std::numeric_limits<TimeNs>::max() : ns_from_seconds(t_s) - 2 * step_ns_;
  const auto end =
      std::partition_point(pending_.begin(), pending_.end(),
                           [&](const SensedEvent& event) { return event.t_ns < complete_ns; });
  ready_.clear();
  const auto collect = [&](std::span<const SensedEvent> events) {
    ready_.insert(ready_.end(), events.begin(), events.end());
  };
  output_.push({pending_.begin(), end}, complete_ns, collect);
  if (is_last) output_.finish(collect);
  pending_.erase(pending_.begin(), end);
  sink(ready_, t_s);
}

void EventDelivery::save(StateWriter& state) const {
  state.values(pending_);
  state.text(output_.state());
}

void EventDelivery::load(StateReader& state) {
  state.values(pending_);
  output_.load(state.text());
}

}  // namespace saccade
