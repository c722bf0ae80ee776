#include "estimator/refinement/observed_edges.h"

#include <algorithm>

#include "estimator/refinement/event_steps.h"

namespace saccade {
namespace {

/// Steps that an event lags behind the level between its own and the one before, on average.
constexpr double kFirstLag = 0.25;

}  // namespace

ObservedEdges::ObservedEdges(const ViewWindow& window, const RayEdges& edges,
                             const PinholeCamera& camera, const NodeCorrection& correction,
                             int pairs)
    : window_(window),
      edges_(edges),
      camera_(camera),
      undistorted_(camera.undistorted()),
      correction_(correction),
      most_(2 * static_cast<std::size_t>(pairs)),
      view_from_world_(window.world_from_reference().inverse()),
      steps_(event_steps(window.events, camera)) {}

std::vector<ChosenEvent> ObservedEdges::of(const FittedEdge& edge) const {
  std::vector<std::uint32_t> events(edges_.events.event.begin() + edge.first,
                                    edges_.events.event.begin() + edge.last);
  std::sort(events.begin(), events.end());
  const double mean = mean_step(steps_, events);
  const auto node_of = [&](std::uint32_t e) { return correction_.before(time_s(e)).first; };
  std::vector<ChosenEvent> chosen;
  for (auto first = events.begin(); first != events.end();) {
    const auto last = std::partition_point(
        first, events.end(),
        [&, node = node_of(*first)](std::uint32_t e) { return node_of(e) == node; });
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t taken = std::min(most_, count);
    for (std::size_t i = 0; i < taken; ++i) {
      const std::size_t at = (2 * i + 1) * count / (2 * taken);
      chosen.push_back(observed(edge, mean, *(first + static_cast<std::ptrdiff_t>(at))));
    }
    first = last;
  }
  return chosen;
}

double ObservedEdges::time_s(std::uint32_t event) const {
  return seconds_from_ns(window_.events[event].t_ns);
}

ChosenEvent ObservedEdges::observed(const FittedEdge& edge, double mean_step,
                                    std::uint32_t index) const {
  const Event& event = window_.events[index];
  const double t_s = time_s(index);
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
