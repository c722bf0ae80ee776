#include "simulator/sensor/event_delivery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kEventsPerBucket = 4;

/// Puts `events` in SensedEventOrder: a counting sort spreads them over short spans of time, which
/// they fill evenly enough, and what shares a span is sorted there. `spare` is scratch memory.
void sort_events(SensedEvents& events, SensedEvents& spare) {
  if (events.size() < 2) return;
  const auto earlier = [](const SensedEvent& a, const SensedEvent& b) { return a.t_ns < b.t_ns; };
  const auto [first, last] = std::minmax_element(events.begin(), events.end(), earlier);
  const TimeNs start_ns = first->t_ns;
  const std::size_t buckets = events.size() / kEventsPerBucket + 1;
  const double buckets_per_ns =
      static_cast<double>(buckets) / (static_cast<double>(last->t_ns - start_ns) + 1);
  const auto bucket_of = [&](const SensedEvent& event) {
    return static_cast<std::size_t>(static_cast<double>(event.t_ns - start_ns) * buckets_per_ns);
  };
  std::vector<std::uint32_t> ends(buckets + 1);
  for (const SensedEvent& event : events) ++ends[bucket_of(event)];
  std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), std::uint32_t{0});
  spare.resize(events.size());
  for (const SensedEvent& event : events) spare[ends[bucket_of(event)]++] = event;
  // Each end is now where the next bucket starts.
  auto begin = spare.begin();
  for (std::size_t i = 0; i < buckets; ++i) {
    const auto end = spare.begin() + ends[i];
    std::sort(begin, end, SensedEventOrder());
    begin = end;
  }
  events.swap(spare);
}

}  // namespace

EventDelivery::EventDelivery(const EventOptions& options, const PinholeCamera& camera,
                             std::uint64_t seed)
    : unit_ns_(options.timestamp_unit_ns()),
      output_(options.noise, camera.width, camera.height, unit_ns_, seed) {}

void EventDelivery::deliver(double t_s, bool is_last, const Sink& sink) {
  if (is_last) {
    // The recording is half open: a camera that comes to its start again at the very end intersects
    // its first thresholds exactly, and the last bit of rounding may not decide whether it fires.
    const auto end_ns = std::llround(t_s * 1e9 / static_cast<double>(unit_ns_)) * unit_ns_;
    std::erase_if(pending_, [&](const SensedEvent& event) { return event.t_ns >= end_ns; });
  }
  sort_events(pending_, sorted_);
  // Rounding can put a later event on the tick of t_s or on the one before it.
  const TimeNs complete_ns =
      is_last ? std::numeric_limits<TimeNs>::max() : ns_from_seconds(t_s) - 2 * unit_ns_;
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
