#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "core/event.h"

namespace saccade {

/// What made a pixel fire (file values of labels.h5).
enum class EventOrigin : std::uint8_t {
  kSignal = 0,  ///< the brightness of the scene
  kLeak = 1,    ///< more than half of the threshold was supplied by the leaking reference
  kShot = 2,    ///< photon and electron shot noise
  kHot = 3,     ///< a hot pixel
};

/// An event as the simulated sensor produces it: an Event with what only a simulator can know.
struct SensedEvent {
  TimeNs t_ns = 0;
  std::uint16_t x = 0;       ///< column [px], to the right
  std::uint16_t y = 0;       ///< row [px], downwards
  std::int8_t polarity = 1;  ///< +1 brighter (ON), -1 darker (OFF)
  EventOrigin origin = EventOrigin::kSignal;
  float log_intensity = 0;  ///< of the scene at the pixel when it fired

  [[nodiscard]] Event event() const { return {t_ns, x, y, polarity}; }
  [[nodiscard]] bool operator==(const SensedEvent&) const = default;
};

/// EventOrder; events that it holds for equal stand by origin and log intensity, so that the labels
/// are unique as well.
struct SensedEventOrder {
  [[nodiscard]] bool operator()(const SensedEvent& a, const SensedEvent& b) const {
    return std::tie(a.t_ns, a.y, a.x, a.polarity, a.origin, a.log_intensity) <
           std::tie(b.t_ns, b.y, b.x, b.polarity, b.origin, b.log_intensity);
  }
};

using SensedEvents = std::vector<SensedEvent>;

}  // namespace saccade
