#pragma once

#include <cstdint>
#include <span>

#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// A part of the sensor behind the pixels that moves the time stamps of events, or loses some. It
/// is called once per batch.
class OutputStage {
 public:
  OutputStage() = default;
  OutputStage(const OutputStage&) = delete;
  OutputStage& operator=(const OutputStage&) = delete;
  virtual ~OutputStage() = default;
  /// `events`: in time order over all calls.
  virtual void push(std::span<const SensedEvent> events) = 0;
  /// Appends the events whose new time stamp is before `complete_ns` to `out`, in SensedEventOrder
  /// over all calls. Contract: every event that is pushed later has t_ns >= complete_ns.
  virtual void release(TimeNs complete_ns, SensedEvents& out) = 0;
  /// Number of events that the stage has dropped so far.
  [[nodiscard]] virtual std::uint64_t lost() const { return 0; }
  /// Everything that later output depends on. Also saved while the model is off, so that the layout
  /// of a saved state does not depend on the configuration.
  virtual void save(StateWriter& state) const = 0;
  virtual void load(StateReader& state) = 0;
};

}  // namespace saccade
