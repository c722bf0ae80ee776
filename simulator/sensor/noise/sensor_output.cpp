#include "simulator/sensor/noise/sensor_output.h"

#include <limits>

namespace saccade {

SensorOutput::SensorOutput(const NoiseOptions& options, double log_eps, int width, int height,
                           TimeNs step_ns, std::uint64_t seed)
    : delay_(options.latency, log_eps, width, height, step_ns, seed),
      bus_(options.readout, height, step_ns),
      delays_(options.latency.on()),
      queues_(options.readout.on()) {}

void SensorOutput::push(std::span<const SensedEvent> events, TimeNs complete_ns, const Sink& sink) {
  fired_ += events.size();
  SensedEvents delayed;
  if (delays_) {
    delay_.push(events);
    delay_.take(complete_ns, delayed);
    events = delayed;
  }
  SensedEvents served;
  if (queues_) {
    bus_.push(events);
    bus_.take(complete_ns, served);
    events = served;
  }
  recorded_ += events.size();
  if (!events.empty()) sink(events);
}

void SensorOutput::finish(const Sink& sink) { push({}, std::numeric_limits<TimeNs>::max(), sink); }

OutputCounts SensorOutput::counts() const { return {fired_, recorded_, bus_.lost()}; }

std::string SensorOutput::state() const {
  StateWriter state;
  state.value(fired_);
  state.value(recorded_);
  delay_.save(state);
  bus_.save(state);
  return state.take();
}

void SensorOutput::load(std::string_view state) {
  StateReader reader(state);
  reader.value(fired_);
  reader.value(recorded_);
  delay_.load(reader);
  bus_.load(reader);
  if (!reader.at_end()) throw InputError("saved state", "is longer than that of this sensor");
}

}  // namespace saccade
