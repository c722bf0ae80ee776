#include "simulator/sensor/noise/sensor_output.h"

#include <limits>

namespace saccade {

SensorOutput::SensorOutput(const NoiseOptions& options, int width, int height, TimeNs unit_ns,
                           std::uint64_t seed) {
  const OutputStageInput input{options, width, height, unit_ns, seed};
  for (const NoiseModel& model : noise_models())
    if (model.make_stage != nullptr)
      stages_.push_back({model.make_stage(input), model.is_on(options)});
}

void SensorOutput::push(std::span<const SensedEvent> events, TimeNs complete_ns, const Sink& sink) {
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

void SensorOutput::finish(const Sink& sink) { push({}, std::numeric_limits<TimeNs>::max(), sink); }

std::uint64_t SensorOutput::lost() const {
  std::uint64_t lost = 0;
  for (const Stage& each : stages_) lost += each.stage->lost();
  return lost;
}

std::string SensorOutput::state() const {
  StateWriter state;
  state.value(fired_);
  state.value(recorded_);
  for (const Stage& each : stages_) each.stage->save(state);
  return state.bytes();
}

void SensorOutput::load(std::string_view state) {
  StateReader reader(state);
  reader.value(fired_);
  reader.value(recorded_);
  for (const Stage& each : stages_) each.stage->load(reader);
  if (!reader.at_end()) throw InputError("saved state", "is longer than that of this sensor");
}

}  // namespace saccade
