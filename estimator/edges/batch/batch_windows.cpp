#include "estimator/edges/batch/batch_windows.h"

#include <algorithm>
#include <cmath>

#include "core/time_search.h"

namespace saccade {

std::span<const Event> events_of_view(std::span<const Event> events, double t_s, double window_s) {
  return events_between(events, ns_from_seconds(t_s - window_s / 2),
                        ns_from_seconds(t_s + window_s / 2));
}

std::vector<double> batch_views(std::vector<double> keyframe_s, double end_s, double window_s) {
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
