#include "estimator/edges/edge_matches.h"

#include <algorithm>

#include "core/process/parallel.h"

namespace saccade {
namespace {

constexpr double kReach_px = 2;
constexpr double kDepthTolerance = 0.1;  ///< relative
constexpr float kMinCosine = 0.966F;     ///< of 15 degrees

std::vector<Landmark> landmarks_of(std::span<const FittedEdgel> edges,
                                   const PinholeCamera& camera) {
  std::vector<Landmark> landmarks;
  landmarks.reserve(edges.size());
  for (const FittedEdgel& fitted : edges) {
    const auto rho = static_cast<double>(fitted.edge.inverse_depth);
    landmarks.push_back({camera.ray(fitted.edge.pixel.cast<double>()) / rho,
                         static_cast<double>(fitted.sigma) / rho});
  }
  return landmarks;
}

}  // namespace

std::optional<FittedEdgel> transformed(const Rigid3& other_from_view, FittedEdgel fitted,
                                       const PinholeCamera& camera) {
  Edgel& edge = fitted.edge;
  const double depth_m = 1 / static_cast<double>(edge.inverse_depth);
  const auto moved = [&](const Eigen::Vector2f& pixel) -> Eigen::Vector3d {
    return other_from_view * (depth_m * camera.ray(pixel.cast<double>()));
  };
  const Eigen::Vector3d point = moved(edge.pixel);
  const Eigen::Vector3d along = moved(edge.pixel + edge.tangent());
  if (!(point.z() > 0 && along.z() > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = camera.project(point);
  const Eigen::Vector2d tangent = (camera.project(along) - pixel).normalized();
  edge.pixel = pixel.cast<float>();
  edge.normal = Eigen::Vector2f(static_cast<float>(tangent.y()), static_cast<float>(-tangent.x()));
  fitted.sigma *= static_cast<float>(depth_m / point.z());
  edge.inverse_depth = static_cast<float>(1 / point.z());
  return fitted;
}

EdgeMatcher::EdgeMatcher(std::span<const FittedEdgel> edges, const Rigid3& other_from_view,
                         const PinholeCamera& camera)
    : edges_(edges),
      other_from_view_(other_from_view),
      camera_(camera),
      landmarks_(landmarks_of(edges, camera), other_from_view, camera) {}

std::optional<std::size_t> EdgeMatcher::match(const Edgel& edge) const {
  const ProjectedLandmarks::Projection* nearest =
      landmarks_.nearest(edge, kReach_px, kDepthTolerance);
  if (nearest == nullptr) return std::nullopt;
  const auto other = transformed(other_from_view_, edges_[nearest->index], camera_);
  if (!other || other->edge.normal.dot(edge.normal) < kMinCosine) return std::nullopt;
  return nearest->index;
}

std::vector<std::vector<EdgeOfView>> reobservations(std::span<const EdgeOfView> edges,
                                                    std::span<const EdgeView> views,
                                                    std::span<const Rigid3> world_from_view,
                                                    Reobserving which,
                                                    const PinholeCamera& camera) {
  std::vector<std::vector<EdgeOfView>> observations(edges.size());
  const auto find = [&](std::size_t view) {
    const auto before = [](const EdgeOfView& edge, std::size_t k) { return edge.view < k; };
    const auto first = std::lower_bound(edges.begin(), edges.end(), view, before);
    const auto last = std::lower_bound(first, edges.end(), view + 1, before);
    if (first == last) return;
    const Rigid3 view_from_world = world_from_view[view].inverse();
    const bool later = which == Reobserving::kLater;
    for (std::size_t other = later ? view + 1 : 0; other < (later ? views.size() : view); ++other) {
      if (views[other].shares_events_with(views[view])) continue;
      const EdgeMatcher matcher(views[other].edges, view_from_world * world_from_view[other],
                                camera);
      for (auto edge = first; edge != last; ++edge)
        if (const auto match = matcher.match(views[view].edges[edge->edge].edge))
          observations[static_cast<std::size_t>(edge - edges.begin())].push_back({other, *match});
    }
  };
  parallel_for(views.size(), find);
  return observations;
}

}  // namespace saccade
