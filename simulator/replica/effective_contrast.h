#pragma once

#include <optional>
#include <span>

#include "core/io/events/event_file.h"
#include "simulator/sensor/pixel/sensed_event.h"

namespace saccade {

/// Changes of the log intensity from an event of a pixel to its next, by the next one's polarity.
struct ContrastSums {
  double on = 0, off = 0;  ///< both > 0 where the signal goes with the events [log units]
  double on_count = 0, off_count = 0;

  ContrastSums& operator+=(const ContrastSums& other);
  /// What an event stands for; nullopt without events.
  [[nodiscard]] std::optional<double> mean_on() const;
  [[nodiscard]] std::optional<double> mean_off() const;
};

/// Of events that the signal caused, in order of time. A pixel that is blind for a time takes the
/// change then into its next reference, so that an event stands for more than its threshold where the
/// signal goes on, and for less where it turns.
[[nodiscard]] ContrastSums contrast_sums(std::span<const SensedEvent> events, SensorSize size);

}  // namespace saccade
