#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "simulator/sensor/noise/output_stage.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {
namespace config {
class Fields;
}

/// Time from the crossing to the request at the bus:
///   latency = max(0, mean_us + jitter_us z),   z ~ N(0, 1) cut at +-4
/// The bandwidth model brings a latency of its own, which grows in the dark; state only the rest
/// here when both are on.
struct LatencyOptions {
  double mean_us = 0;
  double jitter_us = 0;

  [[nodiscard]] bool on() const { return mean_us > 0 || jitter_us > 0; }
};
void describe(config::Fields& fields, LatencyOptions& options);

/// Latency and jitter (formula at LatencyOptions). An event never precedes its pixel's previous
/// one, and comes at least one step later when the polarity has changed, so that the order in which
/// a pixel fired can be read from the stream. The jitter's draw is that of the pixel's n-th event.
class EventDelay final : public OutputStage {
 public:
  /// Times are multiples of `unit_ns`; so are the delayed ones (nearest). With `options` off only
  /// load() and save() may be called.
  EventDelay(const LatencyOptions& options, int width, int height, TimeNs unit_ns,
             std::uint64_t seed);

  void push(std::span<const SensedEvent> events) override;
  void release(TimeNs complete_ns, SensedEvents& out) override;

  void save(StateWriter& state) const override;
  void load(StateReader& state) override;

 private:
  /// Without padding.
  struct Pixel {
    TimeNs last_ns = 0;
    std::uint32_t events = 0;
    std::int32_t polarity = 0;  ///< of the last event; 0: none yet
  };

  [[nodiscard]] double latency_ns(const SensedEvent& event, std::uint32_t index) const;

  LatencyOptions options_;
  int width_;
  TimeNs unit_ns_;
  Random random_;
  std::vector<Pixel> pixels_;
  SensedEvents waiting_;  ///< a heap, the first event in SensedEventOrder at the front
};

}  // namespace saccade
