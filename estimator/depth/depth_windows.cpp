#include "estimator/depth/depth_windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace saccade {
namespace {

std::size_t first_at(std::span<const Event> events, TimeNs t_ns) {
  const auto at = std::partition_point(events.begin(), events.end(),
                                       [t_ns](const Event& e) { return e.t_ns < t_ns; });
  return static_cast<std::size_t>(at - events.begin());
}

double reference_time(double start_s, double end_s, DepthWindowOptions::Reference reference) {
  switch (reference) {
    case DepthWindowOptions::Reference::kStart:
      return start_s;
    case DepthWindowOptions::Reference::kMiddle:
      return (start_s + end_s) / 2;
    case DepthWindowOptions::Reference::kEnd:
      return end_s;
  }
  return start_s;
}

DepthWindow window_of(std::span<const Event> events, const Trajectory& trajectory, double start_s,
                      double end_s, const DepthWindowOptions& options) {
  return {events, &trajectory, reference_time(start_s, end_s, options.reference)};
}

}  // namespace

std::span<const Event> within(std::span<const Event> events, const Trajectory& trajectory) {
  if (trajectory.empty()) return {};
  const std::size_t begin = first_at(events, ns_from_seconds(trajectory.start_s()));
  const std::size_t end = first_at(events, ns_from_seconds(trajectory.end_s()) + 1);
  return events.subspan(begin, end - begin);
}

std::vector<DepthWindow> cut_windows(std::span<const Event> events, const Trajectory& trajectory,
                                     const DepthWindowOptions& options) {
  std::vector<DepthWindow> windows;
  if (events.empty()) return windows;
  const double start_s = seconds_from_ns(events.front().t_ns);
  const double length_s = seconds_from_ns(events.back().t_ns) - start_s;
  const auto size = static_cast<double>(events.size());
  const bool by_time = options.by == DepthWindowOptions::By::kTime;
  const double pieces = by_time ? length_s / options.duration_s : size / options.events;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(pieces - 1e-9)));
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double end_share = static_cast<double>(i + 1) / static_cast<double>(count);
    std::size_t end = events.size();
    if (i + 1 < count)
      end = by_time ? first_at(events, ns_from_seconds(start_s + end_share * length_s))
                    : static_cast<std::size_t>(end_share * size);
    if (end > begin) {
      const auto part = events.subspan(begin, end - begin);
      const double from_s = seconds_from_ns(part.front().t_ns);
      const double to_s = seconds_from_ns(part.back().t_ns);
      windows.push_back(window_of(part, trajectory, from_s, to_s, options));
    }
    begin = end;
  }
  return windows;
}

}  // namespace saccade
