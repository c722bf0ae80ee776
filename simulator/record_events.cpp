#include "simulator/record_events.h"

#include <memory>
#include <optional>

#include "core/io/events/labels_h5.h"
#include "core/process/progress.h"
#include "simulator/event_source.h"
#include "simulator/recording_loop.h"
#include "simulator/sensor/event_labels.h"

namespace saccade {
namespace {

std::uint64_t microseconds(double t_s) { return static_cast<std::uint64_t>(1e6 * t_s); }

/// Records what the log does not hold yet.
void fill(const CameraRecording& recording) {
  const std::unique_ptr<EventSource> camera =
      make_event_source(recording.events, recording.seed, recording.scene, recording.colours,
                        recording.world_from_camera, recording.camera);
  double shown_s = recording.log.reached_s();
  Progress progress("events", microseconds(recording.duration_s()), "simulated us",
                    microseconds(shown_s));
  record_into(recording.log, *camera, recording.duration_s(), [&](double t_s) {
    progress.add(microseconds(t_s) - microseconds(shown_s));
    shown_s = t_s;
  });
}

/// Events that are labelled together: whole packets of rays.
constexpr std::size_t kLabelBatch = 4096;

/// The events of the log, and their labels where they are asked for.
void write(const CameraRecording& recording) {
  std::optional<LabelsH5Writer> labels;
  if (recording.config.groundtruth.event_labels)
    labels.emplace(recording.writer.folder() / "labels.h5");
  const EventLabeller labeller(recording.scene, recording.world_from_camera, recording.camera);
  Events events;
  SensedEvents unlabelled;
  recording.log.replay([&](std::span<const SensedEvent> part) {
    events.clear();
    for (const SensedEvent& event : part) events.push_back(event.event());
    recording.writer.write_events(events);
    if (!labels) return;
    // Packets of rays are filled alike however the log is cut: what a ray at an edge intersects may
    // depend on its neighbours.
    unlabelled.insert(unlabelled.end(), part.begin(), part.end());
    const auto whole = static_cast<std::ptrdiff_t>(unlabelled.size() / kLabelBatch * kLabelBatch);
    labels->append(labeller.label({unlabelled.begin(), unlabelled.begin() + whole}));
    unlabelled.erase(unlabelled.begin(), unlabelled.begin() + whole);
  });
  if (!labels) return;
  labels->append(labeller.label(unlabelled));
  labels->close();
}

}  // namespace

EventStatistics record_events(const CameraRecording& recording) {
  if (!recording.log.statistics()) fill(recording);
  write(recording);
  return *recording.log.statistics();
}

}  // namespace saccade
