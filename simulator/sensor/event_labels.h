#pragma once

#include <span>

#include "core/io/events/labels_h5.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/pixel/sensed_event.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// What the ray through the pixel's centre sees at the recorded time of an event: its depth, its
/// motion in the image, its object, instance and class; and the event's origin. An event that latency or readout delays
/// is labelled at the delayed time, as whoever reads the dataset looks it up.
class EventLabeller {
 public:
  /// `scene` and `world_from_camera` must outlive the labeller.
  EventLabeller(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera);

  /// One label per event, in parallel.
  [[nodiscard]] EventLabels label(std::span<const SensedEvent> events) const;

 private:
  void label_packet(std::span<const SensedEvent> events, std::size_t first,
                    EventLabels& labels) const;

  const Scene& scene_;
  const Spline& motion_;
  PixelRays rays_;
};

}  // namespace saccade
