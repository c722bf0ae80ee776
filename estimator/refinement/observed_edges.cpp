#include "estimator/refinement/observed_edges.h"

#include <algorithm>

#include "estimator/refinement/event_steps.h"

namespace saccade {
namespace {

/// Steps that an event lags behind the level between its own and the one before, on average.
constexpr double kFirstLag = 0.25;

}  // namespace

ObservedEdges::ObservedEdges(const ViewWindow& window, const WindowEdgels& edges,
                             const PinholeCamera& camera, const NodeCorrection& correction,
                             const EventShares& shares)
    : window_(window),
      edges_(edges),
      camera_(camera),
      undistorted_(camera.undistorted()),
      correction_(correction),
      view_from_world_(window.world_from_reference().inverse()),
      steps_(event_steps(window.events, camera)) {
  for (int node = 1; node < correction.count(); ++node) {
    const auto next =
        std::partition_point(window.events.begin(), window.events.end(), [&](const Event& event) {
          return correction.before(seconds_from_ns(event.t_ns)).first < node;
        });
    const bool is_given = correction.time_s(node - 1) < shares.given_until_s;
    nodes_.push_back({static_cast<std::uint32_t>(next - window.events.begin()),
                      2 * static_cast<std::size_t>(is_given ? shares.given_pairs : shares.pairs)});
  }
}

std::vector<ChosenEvent> ObservedEdges::of(const FittedEdgel& edge) const {
  std::vector<std::uint32_t> events(edges_.events.event.begin() + edge.first,
                                    edges_.events.event.begin() + edge.last);
  std::sort(events.begin(), events.end());
  const double mean = mean_step(steps_, events);
  std::vector<ChosenEvent> chosen;
  for (auto first = events.begin(); first != events.end();) {
    // By index, since an edge's events lie all over the window's.
    const NodeEvents& node = *std::upper_bound(
        nodes_.begin(), nodes_.end(), *first,
        [](std::uint32_t event, const NodeEvents& other) { return event < other.end; });
    const auto last = std::lower_bound(first, events.end(), node.end);
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t taken = std::min(node.most, count);
    for (std::size_t i = 0; i < taken; ++i) {
      const std::size_t at = (2 * i + 1) * count / (2 * taken);
      chosen.push_back(observed(edge, mean, *(first + static_cast<std::ptrdiff_t>(at))));
    }
    first = last;
  }
  return chosen;
}

ChosenEvent ObservedEdges::observed(const FittedEdgel& edge, double mean_step,
                                    std::uint32_t index) const {
  const Event& event = window_.events[index];
  const double t_s = seconds_from_ns(event.t_ns);
  EdgeObservation observation;
  observation.view_from_camera = view_from_world_ * window_.trajectory->at_clamped(t_s);
  observation.ray = undistorted_.ray(camera_.undistort({event.x, event.y}));
  const double lag = steps_[index] > 0 ? steps_[index] - mean_step : 0;
  observation.lag = event.polarity * (lag + kFirstLag);
  observation.pixel = edge.edge.pixel.cast<double>();
  observation.normal = edge.edge.normal.cast<double>();
  const auto [node, share] = correction_.before(t_s);
  return {observation, node, share};
}

}  // namespace saccade
