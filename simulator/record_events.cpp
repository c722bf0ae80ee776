#include "simulator/record_events.h"

#include <optional>
#include <string>

#include "core/io/labels_h5.h"
#include "core/progress.h"
#include "simulator/sensor/event_labels.h"

namespace saccade {
namespace {

std::uint64_t microseconds(double t_s) { return static_cast<std::uint64_t>(1e6 * t_s); }

/// Until the camera's state can be saved, an interrupted recording begins again.
template <class Camera>
concept Resumable = requires(Camera camera, std::string state) {
  camera.resume(state);
  state = camera.state();
};

[[maybe_unused]] void append(EventLog& log, std::span<const SensedEvent> events) {
  log.append(events);
}

[[maybe_unused]] void append(EventLog& log, std::span<const Event> events) {
  SensedEvents sensed;
  for (const Event& e : events) sensed.push_back({e.t_ns, e.x, e.y, e.polarity});
  log.append(sensed);
}

/// Records what the log does not hold yet.
template <class Camera>
void fill(Camera& camera, const Take& take) {
  EventLog& log = take.log;
  double shown_s = log.reached_s();
  Progress progress("events", microseconds(take.duration_s()), "simulated us",
                    microseconds(shown_s));
  if constexpr (Resumable<Camera>)
    if (shown_s > 0) camera.resume(log.take_state());
  camera.record(take.duration_s(), [&](auto events, double t_s) {
    append(log, events);
    if constexpr (Resumable<Camera>)
      if (log.wants_checkpoint()) log.checkpoint(t_s, camera.state());
    progress.add(microseconds(t_s) - microseconds(shown_s));
    shown_s = t_s;
  });
  log.complete(camera.statistics());
}

/// The events of the log, and their labels where they are asked for.
void write(const Take& take) {
  std::optional<LabelsH5Writer> labels;
  if (take.config.groundtruth.event_labels) labels.emplace(take.writer.folder() / "labels.h5");
  const EventLabeller labeller(take.scene, take.world_from_camera, take.camera);
  Events events;
  take.log.replay([&](std::span<const SensedEvent> part) {
    events.clear();
    for (const SensedEvent& event : part) events.push_back(event.event());
    take.writer.write_events(events);
    if (labels) labels->append(labeller.label(part));
  });
  if (labels) labels->close();
}

}  // namespace

EventStatistics record_events(const Take& take) {
  if (!take.log.statistics()) {
    EventCamera camera(take.scene, take.world_from_camera, take.camera, take.events);
    fill(camera, take);
  }
  write(take);
  return *take.log.statistics();
}

}  // namespace saccade
