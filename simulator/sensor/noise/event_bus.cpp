#include "simulator/sensor/noise/event_bus.h"

#include <algorithm>
#include <cmath>

#include "core/config/fields.h"

namespace saccade {
namespace {

constexpr double kNsPerSecond = 1e9;

std::size_t line_count(const ReadoutOptions& options, int height) {
  return options.rows ? static_cast<std::size_t>(height) : 1;
}

}  // namespace

void describe(config::Fields& fields, ReadoutOptions& options) {
  fields
      .value("rate_hz", options.rate_hz,
             "Number of events that the bus transfers per second. 0 means without a limit.")
      .range(0, 1e12);
  fields.value("rows", options.rows,
               "Whether all waiting events of a row leave together under one time stamp.");
  fields
      .value("capacity", options.capacity,
             "Number of events that can wait; further ones are lost and counted. 0 means without a "
             "limit.")
      .at_least(0);
  fields.expect(options.rate_hz > 0 || (!options.rows && options.capacity == 0), "rate_hz",
                "must be above 0 for rows and capacity");
}

EventBus::EventBus(const ReadoutOptions& options, int height, TimeNs unit_ns)
    : options_(options),
      unit_ns_(unit_ns),
      service_ns_(options.on() ? kNsPerSecond / options.rate_hz : 0),
      lines_(line_count(options, height)) {}

void EventBus::push(std::span<const SensedEvent> events) {
  for (const SensedEvent& event : events) {
    serve_before(event.t_ns);
    if (options_.capacity > 0 && waiting_ >= static_cast<std::uint64_t>(options_.capacity))
      ++lost_;
    else
      enqueue({requests_++, event});
  }
}

void EventBus::enqueue(const Request& request) {
  const std::size_t index = options_.rows ? request.event.y : 0;
  if (lines_[index].empty()) service_order_.push({request.number, index});
  lines_[index].push_back(request);
  ++waiting_;
}

void EventBus::serve_before(TimeNs t_ns) {
  while (!service_order_.empty()) {
    const Service service = service_order_.top();
    const auto request_ns = static_cast<double>(lines_[service.second].front().event.t_ns);
    const double start_ns = std::max(free_ns_, request_ns);
    if (start_ns >= static_cast<double>(t_ns)) return;
    service_order_.pop();
    serve(service, start_ns);
  }
}

void EventBus::serve(const Service& service, double start_ns) {
  std::deque<Request>& line = lines_[service.second];
  const TimeNs stamp_ns = unit_ns_ * std::llround(start_ns / static_cast<double>(unit_ns_));
  double busy_ns = 0;
  do {
    served_.push_back(line.front().event);
    served_.back().t_ns = stamp_ns;
    line.pop_front();
    busy_ns += service_ns_;
    --waiting_;
  } while (options_.rows && !line.empty() &&
           static_cast<double>(line.front().event.t_ns) <= start_ns);
  free_ns_ = start_ns + busy_ns;
  if (!line.empty()) service_order_.push({line.front().number, service.second});
}

void EventBus::release(TimeNs complete_ns, SensedEvents& out) {
  serve_before(complete_ns);
  // A service at or after this multiple of the step is stamped with it or a later one.
  const TimeNs below_ns = complete_ns - complete_ns % unit_ns_;
  const auto end = std::ranges::partition_point(
      served_, [below_ns](const SensedEvent& e) { return e.t_ns < below_ns; });
  std::sort(served_.begin(), end, SensedEventOrder{});
  out.insert(out.end(), served_.begin(), end);
  served_.erase(served_.begin(), end);
}

void EventBus::save(StateWriter& state) const {
  std::vector<Request> queue;
  for (const auto& line : lines_) queue.insert(queue.end(), line.begin(), line.end());
  std::ranges::sort(queue, {}, &Request::number);
  state.value(free_ns_);
  state.value(requests_);
  state.value(lost_);
  state.values(queue);
  state.values(served_);
}

void EventBus::load(StateReader& state) {
  std::vector<Request> queue;
  state.value(free_ns_);
  state.value(requests_);
  state.value(lost_);
  state.values(queue);
  state.values(served_);
  for (const Request& request : queue) {
    if (options_.rows && request.event.y >= lines_.size())
      throw InputError("saved state", "belongs to a sensor of another size");
    enqueue(request);
  }
}

}  // namespace saccade
