#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/camera.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/sensor_output.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// The path of the events from all pixels to the recording: put in order, through the part of the
/// sensor behind the pixels, and handed on as soon as none can come before them.
class EventDelivery {
 public:
  /// Receives the events up to a time [s], in SensedEventOrder over all calls.
  using Sink = std::function<void(std::span<const SensedEvent> events, double t_s)>;

  /// `seed` is that of the sensor's imperfections.
  EventDelivery(const EventOptions& options, const PinholeCamera& camera, std::uint64_t seed);

  /// Where new events are appended, in a fixed order.
  [[nodiscard]] SensedEvents& pending() { return pending_; }
  /// All events up to `t_s` are pending; `is_last`: none will follow, and those at `t_s` itself are
  /// left out.
  void deliver(double t_s, bool is_last, const Sink& sink);

  /// Events that met a full readout.
  [[nodiscard]] std::uint64_t lost() const { return output_.lost(); }

  /// Everything that later deliveries depend on.
  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  TimeNs unit_ns_;
  SensedEvents pending_;  ///< found but not yet handed on
  SensorOutput output_;
  SensedEvents sorted_;  ///< scratch memory
  SensedEvents ready_;   ///< to be handed to the sink; kept for its memory
};

}  // namespace saccade
