#include "estimator/edges/edge_view.h"

#include <algorithm>
#include <cstdint>

#include "core/process/parallel.h"
#include "core/time_search.h"
#include "estimator/edges/polarity_runs.h"

namespace saccade {
namespace {

constexpr std::size_t kGrain = 64;  ///< edges that a thread takes at a time

void append_evenly(std::span<const std::uint32_t> events, int most,
                   std::vector<std::uint32_t>& chosen) {
  for (const std::size_t i : evenly(events.size(), most)) chosen.push_back(events[i]);
}

}  // namespace

std::vector<std::size_t> evenly(std::size_t count, int most) {
  const std::size_t size = std::min(count, static_cast<std::size_t>(most));
  std::vector<std::size_t> some(size);
  for (std::size_t i = 0; i < size; ++i) some[i] = i * count / size;
  return some;
}

EdgeView edge_view(const ViewWindow& window, const WindowEdgels& found, const PinholeCamera& camera,
                   const EdgeViewOptions& options) {
  const PinholeCamera undistorted = camera.undistorted();
  const std::vector<std::uint8_t> positions = run_positions(window.events, camera);
  const auto time_s = [&](std::uint32_t e) { return seconds_from_ns(window.events[e].t_ns); };
  std::vector<std::vector<EdgeEvent>> of_edge(found.edges.size());
  const auto choose = [&](std::size_t i) {
    const FittedEdgel& edge = found.edges[i];
    std::vector<std::uint32_t> events(found.events.event.begin() + edge.first,
                                      found.events.event.begin() + edge.last);
    std::sort(events.begin(), events.end());
    const double mean = mean_run_position(positions, events);
    const std::size_t given = count_until(events, options.given_until_s, time_s);
    std::vector<std::uint32_t> chosen;
    append_evenly(std::span(events).first(given), options.given_events_per_edge, chosen);
    append_evenly(std::span(events).subspan(given), options.events_per_edge, chosen);
    of_edge[i].reserve(chosen.size());
    for (const std::uint32_t e : chosen) {
      const Event& event = window.events[e];
      const Eigen::Vector3f ray =
          undistorted.ray(camera.undistort({event.x, event.y})).cast<float>();
      const double offset = positions[e] > 0 ? event.polarity * (positions[e] - mean) : 0;
      of_edge[i].push_back({time_s(e), ray.x(), ray.y(), static_cast<float>(event.polarity),
                            static_cast<float>(offset)});
    }
  };
  parallel_for(found.edges.size(), choose, kGrain);
  EdgeView view;
  view.t_s = window.reference_s;
  view.edges = found.edges;
  if (!window.events.empty()) {
    view.from_s = seconds_from_ns(window.events.front().t_ns);
    view.until_s = seconds_from_ns(window.events.back().t_ns);
  }
  for (std::size_t i = 0; i < of_edge.size(); ++i) {
    view.edges[i].first = static_cast<std::uint32_t>(view.events.size());
    view.events.insert(view.events.end(), of_edge[i].begin(), of_edge[i].end());
    view.edges[i].last = static_cast<std::uint32_t>(view.events.size());
  }
  return view;
}

}  // namespace saccade
