#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "simulator/sensor/noise/noise_options.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// Latency and jitter (formula at LatencyOptions). An event never precedes its pixel's previous
/// one, and comes at least one step later when the polarity has changed, so that the order in which
/// a pixel fired can be read from the stream. The jitter's draw is that of the pixel's n-th event.
class EventDelay {
 public:
  /// With `options` off only load() and save() may be called. Times are multiples of `step_ns`; so
  /// are the delayed ones (nearest). `log_eps`: eps of
  /// L = ln(eps + I).
  EventDelay(const LatencyOptions& options, double log_eps, int width, int height, TimeNs step_ns,
             std::uint64_t seed);

  /// `events`: in time order over all calls.
  void push(std::span<const SensedEvent> events);
  /// Appends the delayed events before `complete_ns` to `out`, in SensedEventOrder over all calls.
  /// Contract: every event that is pushed later has t_ns >= complete_ns.
  void take(TimeNs complete_ns, SensedEvents& out);

  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  /// Without padding.
  struct Pixel {
    TimeNs last_ns = 0;
    std::uint32_t events = 0;
    std::int32_t polarity = 0;  ///< of the last event; 0: none yet
  };

  [[nodiscard]] double latency_ns(const SensedEvent& event, std::uint32_t index) const;

  LatencyOptions options_;
  double log_eps_;
  int width_;
  TimeNs step_ns_;
  Random random_;
  std::vector<Pixel> pixels_;
  SensedEvents waiting_;  ///< a heap, the first event in SensedEventOrder at the front
};

}  // namespace saccade
