#pragma once

#include <cstdint>
#include <deque>
#include <queue>
#include <span>
#include <vector>

#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// The readout (ReadoutOptions) as a queue with one server: an event that finds the bus free is
/// stamped with its own time, any other with the time at which its service starts; a service takes
/// 1 / rate per event. With `rows` the row whose first event has waited longest is served, and with
/// it all its events that have come by then, under one stamp. Events of one stamp stand in
/// SensedEventOrder. All times are exact; only the stamp is rounded to the step.
class EventBus {
 public:
  EventBus(const ReadoutOptions& options, int height, TimeNs step_ns);

  /// `events`: requests in time order over all calls.
  void push(std::span<const SensedEvent> events);
  /// Appends the events stamped before `complete_ns` to `out`, in SensedEventOrder over all calls.
  /// Contract: every event that is pushed later has t_ns >= complete_ns.
  void take(TimeNs complete_ns, SensedEvents& out);

  /// Events that met a full queue.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  /// The first request of a line of the queue, in the order of service.
  struct Turn {
    std::uint64_t number;  ///< of the request, counted from the first one
    std::size_t line;
    bool operator>(const Turn& other) const { return number > other.number; }
  };
  struct Request {
    std::uint64_t number;
    SensedEvent event;
  };

  void enqueue(const Request& request);
  /// Starts all services before `t_ns`.
  void serve_before(TimeNs t_ns);
  void serve(const Turn& turn, double start_ns);

  ReadoutOptions options_;
  TimeNs step_ns_;
  double service_ns_;
  double free_ns_ = 0;          ///< when the bus is free again
  std::uint64_t requests_ = 0;  ///< accepted so far
  std::uint64_t waiting_ = 0;
  std::uint64_t lost_ = 0;
  std::vector<std::deque<Request>> lines_;  ///< one per row, or a single one
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;  ///< of lines not empty
  SensedEvents served_;                                                 ///< stamps ascending
};

}  // namespace saccade
