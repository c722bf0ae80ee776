#include "simulator/record_events.h"

#include <optional>

#include "core/error.h"
#include "core/io/events/labels_h5.h"
#include "core/process/progress.h"
#include "simulator/recording_loop.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/bayer/bayer_camera.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/event_labels.h"
#include "simulator/sensor/frame_camera.h"

namespace saccade {
namespace {

std::uint64_t microseconds(double t_s) { return static_cast<std::uint64_t>(1e6 * t_s); }

/// Records what the log does not hold yet with a camera of any kind.
template <class Camera>
void fill(const CameraRecording& recording, Camera&& camera) {
  double shown_s = recording.log.reached_s();
  Progress progress("events", microseconds(recording.duration_s()), "simulated us",
                    microseconds(shown_s));
  record_into(recording.log, camera, recording.duration_s(), [&](double t_s) {
    progress.add(microseconds(t_s) - microseconds(shown_s));
    shown_s = t_s;
  });
}

/// The same in the colours that the configuration asks for.
template <class Camera>
void fill(const CameraRecording& recording) {
  const auto make = [&]<class AnyCamera>(const auto& scene) {
    return AnyCamera(scene, recording.world_from_camera, recording.camera, recording.events,
                     recording.seed);
  };
  if (recording.events.colour_filter == ColourFilter::kNone)
    fill(recording, make.template operator()<Camera>(recording.scene));
  else
    fill(recording, make.template operator()<BayerCamera<Camera>>(*recording.colours));
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

/// From so many triangles on the exact search for what may come into view costs more than the rays
/// that it saves.
constexpr std::size_t kManyTriangles = 10'000;

}  // namespace

Sampling chosen_sampling(Sampling sampling, const Scene& scene) {
  if (sampling == Sampling::kExact && scene.is_animated())
    throw InputError("events.sampling",
                     "exact cannot be combined with an animated mesh: its proofs hold for rigid "
                     "motion; state adaptive, auto or frames");
  if (sampling != Sampling::kAuto) return sampling;
  if (scene.is_animated()) return Sampling::kAdaptive;
  return scene.is_lit() && scene.triangle_count() >= kManyTriangles ? Sampling::kAdaptive
                                                                    : Sampling::kExact;
}

std::string sampling_reason(Sampling sampling, const Scene& scene) {
  if (sampling != Sampling::kAuto) return "stated";
  if (scene.is_animated()) return "animated meshes";
  return chosen_sampling(sampling, scene) == Sampling::kAdaptive ? "lights and many triangles"
                                                                 : "rigid motion";
}

EventStatistics record_events(const CameraRecording& recording) {
  if (!recording.log.statistics()) {
    switch (chosen_sampling(recording.events.sampling, recording.scene)) {
      case Sampling::kFrames:
        fill<FrameCamera>(recording);
        break;
      case Sampling::kAdaptive:
        fill<AdaptiveCamera>(recording);
        break;
      default:
        fill<EventCamera>(recording);
    }
  }
  write(recording);
  return *recording.log.statistics();
}

}  // namespace saccade
