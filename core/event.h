#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

namespace saccade {

/// Time of one event or sample [ns]. Integers, because a float32 second is 8 us wide after 100 s.
using TimeNs = std::int64_t;

constexpr double kSecondsPerNs = 1e-9;

[[nodiscard]] constexpr double seconds_from_ns(TimeNs t_ns) {
  return static_cast<double>(t_ns) * kSecondsPerNs;
}

/// Nearest nanosecond; |t_s| below 9e9 s.
[[nodiscard]] constexpr TimeNs ns_from_seconds(double t_s) {
  return static_cast<TimeNs>(t_s * 1e9 + (t_s < 0 ? -0.5 : 0.5));
}

/// The log intensity of pixel (x, y) moved by polarity * C since the pixel's last event.
struct Event {
  TimeNs t_ns = 0;
  std::uint16_t x = 0;       ///< column [px], to the right
  std::uint16_t y = 0;       ///< row [px], downwards
  std::int8_t polarity = 1;  ///< +1 brighter (ON), -1 darker (OFF)

  [[nodiscard]] bool operator==(const Event&) const = default;
};

/// The order of every event stream in this project: by time, ties by pixel index (row-major), then
/// by polarity, so that a stream is unique whatever thread produced its parts.
struct EventOrder {
  [[nodiscard]] bool operator()(const Event& a, const Event& b) const {
    return std::tie(a.t_ns, a.y, a.x, a.polarity) < std::tie(b.t_ns, b.y, b.x, b.polarity);
  }
};

using Events = std::vector<Event>;

}  // namespace saccade
