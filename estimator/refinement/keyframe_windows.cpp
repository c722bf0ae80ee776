#include "estimator/refinement/keyframe_windows.h"

#include <algorithm>
#include <cmath>

namespace saccade {

std::span<const Event> events_around(std::span<const Event> events, double t_s, double window_s) {
  const TimeNs from_ns = ns_from_seconds(t_s - window_s / 2);
  const TimeNs to_ns = ns_from_seconds(t_s + window_s / 2);
  const auto before = [](TimeNs limit) {
    return [limit](const Event& e) { return e.t_ns < limit; };
  };
  const auto first = std::partition_point(events.begin(), events.end(), before(from_ns));
  const auto last = std::partition_point(first, events.end(), before(to_ns));
  return {first, last};
}

std::vector<double> views_along(std::vector<double> keyframe_s, double end_s, double window_s) {
  const double most_s = window_s / 3;
  if (keyframe_s.back() < end_s - most_s) keyframe_s.push_back(end_s - most_s);
  std::vector<double> views = {keyframe_s.front()};
  for (std::size_t k = 1; k < keyframe_s.size(); ++k) {
    const double from_s = keyframe_s[k - 1], gap_s = keyframe_s[k] - from_s;
    const int parts = std::max(1, static_cast<int>(std::ceil(gap_s / most_s)));
    for (int i = 1; i <= parts; ++i) views.push_back(from_s + gap_s * i / parts);
  }
  return views;
}

}  // namespace saccade
