#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "simulator/sensor/noise/noise_models.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// The part of the sensor behind the pixels: the stages of noise_models(), one after the other. It
/// turns the stream of true times into the stream of recorded ones, event by event in time order,
/// so how the stream is cut into calls changes nothing. With all stages off it hands out what it
/// got.
class SensorOutput {
 public:
  /// Receives events in SensedEventOrder over all calls.
  using Sink = std::function<void(std::span<const SensedEvent> events)>;

  /// All times are multiples of `unit_ns`.
  SensorOutput(const NoiseOptions& options, int width, int height, TimeNs unit_ns,
               std::uint64_t seed);

  /// Takes `events`, in SensedEventOrder over all calls, and hands out what no later event can
  /// precede. Contract: later calls bring only events with t_ns >= complete_ns.
  void push(std::span<const SensedEvent> events, TimeNs complete_ns, const Sink& sink);
  /// Hands out what still waits, stamped beyond the last time if need be.
  void finish(const Sink& sink);

  /// Number of events handed out so far, and of those that met a full queue.
  [[nodiscard]] std::uint64_t recorded() const { return recorded_; }
  [[nodiscard]] std::uint64_t lost() const;

  /// Everything that later output depends on, for load() of an output made with the same arguments.
  [[nodiscard]] std::string state() const;
  /// Throws InputError where the state does not fit.
  void load(std::string_view state);

 private:
  struct Stage {
    std::unique_ptr<OutputStage> stage;
    bool is_on;
  };

  std::vector<Stage> stages_;  ///< in the order of noise_models()
  std::uint64_t fired_ = 0;
  std::uint64_t recorded_ = 0;
};

}  // namespace saccade
