#include "eval/picture/image/event_picture.h"

#include <algorithm>
#include <cmath>

#include "core/time_search.h"

namespace saccade {

ImageRgb8 draw_events(std::span<const Event> events, int width, int height, const Theme& theme) {
  Image<int> counts(width, height);
  Image<std::int8_t> polarities(width, height);
  for (const Event& event : events) {
    if (event.x >= width || event.y >= height) continue;
    ++counts(event.x, event.y);
    polarities(event.x, event.y) = event.polarity;
  }
  ImageRgb8 picture(width, height, theme.background);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int count = counts.pixels()[i];
    if (count == 0) continue;
    const Rgb8& colour = polarities.pixels()[i] > 0 ? theme.on : theme.off;
    picture.pixels()[i] = mix(theme.background, colour, 0.4 + 0.2 * std::min(count, 3));
  }
  return picture;
}

Events undistort_events(std::span<const Event> events, const PinholeCamera& camera) {
  if (!camera.is_distorted()) return {events.begin(), events.end()};
  const UndistortionTable table(camera);
  Events result;
  for (Event event : events) {
    const Eigen::Vector2f& pixel = table(event.x, event.y);
    const long x = std::lround(pixel.x());
    const long y = std::lround(pixel.y());
    if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) continue;
    event.x = static_cast<std::uint16_t>(x);
    event.y = static_cast<std::uint16_t>(y);
    result.push_back(event);
  }
  return result;
}

std::span<const Event> events_around(std::span<const Event> events, double t_s, std::size_t count,
                                     double max_distance_s) {
  const TimeNs t_ns = ns_from_seconds(t_s);
  const TimeNs max_distance_ns = ns_from_seconds(max_distance_s);
  auto first = events.begin() + static_cast<std::ptrdiff_t>(count_before(events, t_ns));
  auto last = first;
  while (static_cast<std::size_t>(last - first) < count) {
    const bool can_grow_back =
        first != events.begin() && t_ns - (first - 1)->t_ns <= max_distance_ns;
    const bool can_grow_forward = last != events.end() && last->t_ns - t_ns <= max_distance_ns;
    if (!can_grow_back && !can_grow_forward) break;
    if (can_grow_back && (!can_grow_forward || t_ns - (first - 1)->t_ns <= last->t_ns - t_ns))
      --first;
    else
      ++last;
  }
  return {first, last};
}

}  // namespace saccade
