#pragma once

#include <cstdint>
#include <deque>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "simulator/sensor/noise/output_stage.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {
namespace config {
class Fields;
}

/// A bus that serves `rate_hz` events per second in the order of their requests, or row by row: the
/// row that has waited longest sends all its events under one time stamp (Boahen's address-event
/// readout; Brandli et al. 2014). An event that intersects a full queue is lost and counted.
struct ReadoutOptions {
  double rate_hz = 0;  ///< 0: no limit
  bool rows = false;
  std::int64_t capacity = 0;  ///< events that can wait; 0: no limit

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};
void describe(config::Fields& fields, ReadoutOptions& options);

/// The readout (ReadoutOptions) as a queue with one server: an event that finds the bus free is
/// stamped with its own time, any other with the time at which its service starts; a service takes
/// 1 / rate per event. With `rows` the row whose first event has waited longest is served, and with
/// it all its events that have come by then, under one stamp. Events of one stamp stand in
/// SensedEventOrder. All times are exact; only the stamp is rounded to the step.
class EventBus final : public OutputStage {
 public:
  EventBus(const ReadoutOptions& options, int height, TimeNs unit_ns);

  void push(std::span<const SensedEvent> events) override;
  void release(TimeNs complete_ns, SensedEvents& out) override;

  /// Events that met a full queue.
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }

  void save(StateWriter& state) const override;
  void load(StateReader& state) override;

 private:
  /// The first request of a line of the queue: its number, counted from the first one, and the
  /// line. Served in the order of the numbers, which are unique.
  using Service = std::pair<std::uint64_t, std::size_t>;
  struct Request {
    std::uint64_t number;
    SensedEvent event;
  };

  void enqueue(const Request& request);
  /// Starts all services before `t_ns`.
  void serve_before(TimeNs t_ns);
  void serve(const Service& service, double start_ns);

  ReadoutOptions options_;
  TimeNs unit_ns_;
  double service_ns_;
  double free_ns_ = 0;          ///< when the bus is free again
  std::uint64_t requests_ = 0;  ///< accepted so far
  std::uint64_t waiting_ = 0;
  std::uint64_t lost_ = 0;
  std::vector<std::deque<Request>> lines_;  ///< one per row, or a single one
  std::priority_queue<Service, std::vector<Service>, std::greater<>>
      service_order_;    ///< of lines not empty
  SensedEvents served_;  ///< stamps ascending
};

}  // namespace saccade
