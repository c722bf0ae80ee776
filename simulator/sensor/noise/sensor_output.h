#pragma once

#include <cstdint>
#include <functional>
#include <limits>
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
               std::uint64_t seed) {
    const OutputStageInput input{options, width, height, unit_ns, seed};
    for (const NoiseModel& model : noise_models())
      if (model.make_stage != nullptr)
        stages_.push_back({model.make_stage(input), model.is_on(options)});
  }

  /// Takes `events`, in SensedEventOrder over all calls, and hands out what no later event can
  /// precede. Contract: later calls bring only events with t_ns >= complete_ns.
  void push(std::span<const SensedEvent> events, TimeNs complete_ns, const Sink& sink) {
    fired_ += events.size();
    SensedEvents held;
    for (const Stage& each : stages_) {
      if (!each.is_on) continue;
      each.stage->push(events);
      held.clear();
      each.stage->release(complete_ns, held);
      events = held;
    }
    recorded_ += events.size();
    if (!events.empty()) sink(events);
  }
  /// Hands out what still waits, stamped beyond the last time if need be.
  void finish(const Sink& sink) { push({}, std::numeric_limits<TimeNs>::max(), sink); }

  /// Number of events handed out so far, and of those that met a full queue.
  [[nodiscard]] std::uint64_t recorded() const { return recorded_; }
  [[nodiscard]] std::uint64_t lost() const {
    std::uint64_t lost = 0;
    for (const Stage& each : stages_) lost += each.stage->lost();
    return lost;
  }

  /// Everything that later output depends on, for load() of an output made with the same arguments.
  [[nodiscard]] std::string state() const {
    StateWriter state;
    state.value(fired_);
    state.value(recorded_);
    for (const Stage& each : stages_) each.stage->save(state);
    return state.bytes();
  }
  /// Throws InputError where the state does not fit.
  void load(std::string_view state) {
    StateReader reader(state);
    reader.value(fired_);
    reader.value(recorded_);
    for (const Stage& each : stages_) each.stage->load(reader);
    if (!reader.at_end()) throw InputError("saved state", "is longer than that of this sensor");
  }

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
