#include "simulator/record_events.h"

#include <optional>

#include "core/io/events/labels_h5.h"
#include "core/process/progress.h"
#include "simulator/recording_loop.h"
#include "simulator/sensor/event_labels.h"
#include "simulator/sensor/frame_camera.h"

namespace saccade {
namespace {

std::uint64_t microseconds(double t_s) { return static_cast<std::uint64_t>(1e6 * t_s); }

/// Records what the log does not hold yet.
template <class Camera>
void fill(const Take& take) {
  Camera camera(take.scene, take.world_from_camera, take.camera, take.events, take.seed);
  double shown_s = take.log.reached_s();
  Progress progress("events", microseconds(take.duration_s()), "simulated us",
                    microseconds(shown_s));
  record_into(take.log, camera, take.duration_s(), [&](double t_s) {
    progress.add(microseconds(t_s) - microseconds(shown_s));
    shown_s = t_s;
  });
}

/// Events that are labelled together: whole packets of rays.
constexpr std::size_t kLabelBatch = 4096;

/// The events of the log, and their labels where they are asked for.
void write(const Take& take) {
  std::optional<LabelsH5Writer> labels;
  if (take.config.groundtruth.event_labels) labels.emplace(take.writer.folder() / "labels.h5");
  const EventLabeller labeller(take.scene, take.world_from_camera, take.camera);
  Events events;
  SensedEvents unlabelled;
  take.log.replay([&](std::span<const SensedEvent> part) {
    events.clear();
    for (const SensedEvent& event : part) events.push_back(event.event());
    take.writer.write_events(events);
    if (!labels) return;
    // Packets of rays are filled alike however the log is cut: what a ray at an edge meets may
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

EventStatistics record_events(const Take& take) {
  if (!take.log.statistics()) {
    if (take.events.sampling == Sampling::kFrames)
      fill<FrameCamera>(take);
    else
      fill<EventCamera>(take);
  }
  write(take);
  return *take.log.statistics();
}

}  // namespace saccade
