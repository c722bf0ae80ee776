#include "estimator/edges/window/observed_edges.h"

#include <algorithm>

#include "estimator/edges/polarity_runs.h"

namespace saccade {
namespace {

/// Contrasts that an event lags behind the log intensity midway between its own threshold and the one
/// before, on average.
constexpr double kMeanLag = 0.25;

}  // namespace

ObservedEdges::ObservedEdges(const ViewWindow& window, const WindowEdgels& edges,
                             const PinholeCamera& camera, const NodeCorrection& correction,
                             const std::function<int(double)>& max_pairs)
    : window_(window),
      edges_(edges),
      camera_(camera),
      undistorted_(camera.undistorted()),
      correction_(correction),
      view_from_camera_(*window.trajectory, seconds_from_ns(window.events.front().t_ns),
                        seconds_from_ns(window.events.back().t_ns),
                        window.world_from_reference().inverse()),
      run_positions_(run_positions(window.events, camera)) {
  for (int node = 1; node < correction.count(); ++node) {
    const auto next =
        std::partition_point(window.events.begin(), window.events.end(), [&](const Event& event) {
          return correction.before(seconds_from_ns(event.t_ns)).first < node;
        });
    nodes_.push_back({static_cast<std::uint32_t>(next - window.events.begin()),
                      2 * static_cast<std::size_t>(max_pairs(correction.time_s(node - 1)))});
  }
}

std::vector<ObservedEvent> ObservedEdges::of(const FittedEdgel& edge) const {
  std::vector<std::uint32_t> events(edges_.events.event.begin() + edge.first,
                                    edges_.events.event.begin() + edge.last);
  std::sort(events.begin(), events.end());
  const double mean = mean_run_position(run_positions_, events);
  std::vector<ObservedEvent> chosen;
  for (auto first = events.begin(); first != events.end();) {
    // By index, since an edge's events lie all over the window's.
    const NodeEvents& node = *std::upper_bound(
        nodes_.begin(), nodes_.end(), *first,
        [](std::uint32_t event, const NodeEvents& other) { return event < other.end; });
    const auto last = std::lower_bound(first, events.end(), node.end);
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t taken = std::min(node.max_events, count);
    for (std::size_t i = 0; i < taken; ++i) {
      const std::size_t at = (2 * i + 1) * count / (2 * taken);
      chosen.push_back(observed(edge, mean, *(first + static_cast<std::ptrdiff_t>(at))));
    }
    first = last;
  }
  return chosen;
}

ObservedEvent ObservedEdges::observed(const FittedEdgel& edge, double mean_position,
                                      std::uint32_t index) const {
  const Event& event = window_.events[index];
  const double t_s = seconds_from_ns(event.t_ns);
  EdgeObservation observation;
  observation.view_from_camera = view_from_camera_.at(t_s);
  observation.ray = undistorted_.ray(camera_.undistort({event.x, event.y}));
  const std::uint8_t position = run_positions_[index];
  const double lag = position > 0 ? position - mean_position : 0;
  observation.lag = event.polarity * (lag + kMeanLag);  // l = p (j - mean j + 1/4)
  observation.pixel = edge.edge.pixel.cast<double>();
  observation.normal = edge.edge.normal.cast<double>();
  const auto [node, fraction] = correction_.before(t_s);
  return {observation, node, fraction};
}

}  // namespace saccade
