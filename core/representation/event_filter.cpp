#include "core/representation/event_filter.h"

#include <limits>

namespace saccade {

std::vector<std::uint8_t> supported_events(std::span<const Event> events, SensorSize size,
                                           TimeNs within_ns) {
  constexpr TimeNs kNever = std::numeric_limits<TimeNs>::min();
  // A ring of pixels around the sensor, which has no events, spares the comparisons with its border.
  const std::size_t stride = static_cast<std::size_t>(size.width) + 2;
  std::vector<TimeNs> neighbour_ns(stride * (static_cast<std::size_t>(size.height) + 2), kNever);
  std::vector<std::uint8_t> is_supported;
  is_supported.reserve(events.size());
  for (const Event& event : events) {
    const std::size_t at = (event.y + std::size_t{1}) * stride + event.x + 1;
    const TimeNs before_ns = neighbour_ns[at];
    is_supported.push_back(before_ns != kNever && event.t_ns - before_ns <= within_ns ? 1 : 0);
    // It is the neighbour of the eight, and not of its own pixel.
    for (const std::size_t row : {at - stride, at, at + stride})
      for (const std::size_t pixel : {row - 1, row, row + 1})
        if (pixel != at) neighbour_ns[pixel] = event.t_ns;
  }
  return is_supported;
}

}  // namespace saccade
