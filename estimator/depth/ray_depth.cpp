#include "estimator/depth/ray_depth.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/image.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

constexpr int kTile_px = 16;
/// By tiles, since what is read for one seed is in the cache for the next; edges that are sure come
/// first within a tile, since they keep those beside them away.
std::vector<EdgeSeed> in_order(const std::vector<EdgeSeed>& seeds) {
  const auto tile = [](float px) { return std::max(0, static_cast<int>(px)) / kTile_px; };
  std::vector<std::tuple<int, int, float, std::size_t>> order(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i)
    order[i] = {tile(seeds[i].pixel.y()), tile(seeds[i].pixel.x()), -seeds[i].score, i};
  std::sort(order.begin(), order.end());
  std::vector<EdgeSeed> sorted;
  sorted.reserve(seeds.size());
  for (const auto& place : order) sorted.push_back(seeds[std::get<3>(place)]);
  return sorted;
}

}  // namespace

RayDepth::RayDepth(const RayDepthOptions& options, const DepthLimits& limits,
                   const PinholeCamera& camera)
    : options_(options), limits_(limits), camera_(camera.undistorted()), undistortion_(camera) {}

DepthResult RayDepth::estimate(const ViewWindow& window) const { return fuse(find_edges(window)); }

RayEdges RayDepth::find_edges(const ViewWindow& window) const {
  double rays_s = 0, seeds_s = 0, regression_s = 0, ownership_s = 0, propagation_s = 0;
  const auto timed = [](double& seconds, const auto& step) {
    const StageClock clock(seconds);
    return step();
  };
  RayEdges found;
  const EventRays rays =
      timed(rays_s, [&] { return EventRays(window, camera_, undistortion_, options_.slabs); });
  const auto seeds =
      timed(seeds_s, [&] { return in_order(find_seeds(rays, camera_, limits_, options_.seeds)); });
  EdgeRefiner refiner(rays, options_.refiner, limits_, camera_);
  found.edges = timed(regression_s, [&] { return fit(refiner, seeds, found.events); });
  const auto own = [&] {
    found.edges = with_own_events(found.edges, found.events, rays.size(), options_.ownership);
    return 0;
  };
  timed(ownership_s, own);
  for (int i = 0; i < options_.propagation.rounds; ++i) {
    timed(propagation_s, [&] {
      propagate(refiner, seeds, found.edges, found.events);
      return 0;
    });
    timed(ownership_s, own);
  }
  for (std::uint32_t& event : found.events.event) event = rays.source[event];
  for (const EdgeSeed& seed : seeds) found.seeds.push_back(seed.pixel);
  found.stages_s = {{"rays", rays_s},
                    {"seeds", seeds_s},
                    {"regression", regression_s},
                    {"ownership", ownership_s},
                    {"propagation", propagation_s}};
  return found;
}

DepthResult RayDepth::fuse(const RayEdges& found) const {
  double fusion_s = 0;
  DepthResult result;
  {
    const StageClock clock(fusion_s);
    result.points = fused(points_of(found.edges), options_.fusion);
  }
  result.candidates = found.seeds;
  result.stages_s = found.stages_s;
  result.stages_s.emplace_back("fusion", fusion_s);
  return result;
}

std::vector<FittedEdge> RayDepth::fit(EdgeRefiner& refiner, const std::vector<EdgeSeed>& seeds,
                                      EdgeEvents& events) const {
  std::vector<FittedEdge> edges;
  for (const EdgeSeed& seed : seeds) {
    if (seed.share < static_cast<float>(options_.propagation.own_share) ||
        seed.strength < static_cast<float>(options_.propagation.own_strength) ||
        seed.parallax_px < static_cast<float>(options_.propagation.own_parallax_px))
      continue;
    if (const auto edge = refiner.refine(seed, events)) edges.push_back(*edge);
  }
  return edges;
}

std::vector<EdgeDepth> RayDepth::points_of(const std::vector<FittedEdge>& edges) const {
  std::vector<EdgeDepth> points;
  for (const FittedEdge& e : edges)
    if (e.unseen_px <= static_cast<float>(options_.max_unseen_px) &&
        camera_.contains(e.edge.pixel.cast<double>()))
      points.push_back(
          {e.edge.pixel.x(), e.edge.pixel.y(), e.edge.inverse_depth, e.sigma, e.edge.normal});
  return points;
}

void RayDepth::propagate(EdgeRefiner& refiner, const std::vector<EdgeSeed>& seeds,
                         std::vector<FittedEdge>& edges, EdgeEvents& events) const {
  const PropagationOptions& options = options_.propagation;
  LocalPlanes planes(supported(points_of(edges), options_.fusion), options.plane);
  refiner.restart(edges, options.spacing_px);
  for (const EdgeSeed& seed : seeds) {
    const float tolerance = static_cast<float>(options.tolerance) * seed.inverse_depth;
    if (refiner.has_found({seed.pixel, seed.normal, seed.inverse_depth}, tolerance)) continue;
    const EdgeDepth* nearest = planes.nearest(seed.pixel.x(), seed.pixel.y());
    if (nearest == nullptr) continue;
    if (std::abs(seed.inverse_depth - nearest->inverse_depth) > tolerance) continue;
    const LocalPlane plane =
        planes.fit({seed.pixel.x(), seed.pixel.y(), nearest->inverse_depth, nearest->sigma});
    if (plane.weights < static_cast<float>(options.min_neighbours)) continue;
    const float model = static_cast<float>(options.plane.model_error) * plane.inverse_depth;
    const Expectation expected{plane.spread * std::hypot(plane.sigma, model),
                               planes.gap_around(seed.pixel.x(), seed.pixel.y(), plane),
                               static_cast<float>(options.min_gap),
                               static_cast<float>(options.max_residual_px),
                               static_cast<float>(options.max_sigma) * plane.inverse_depth};
    const auto edge =
        refiner.confirm({seed.pixel, seed.normal, plane.inverse_depth}, expected, events);
    if (edge) edges.push_back(*edge);
  }
}

}  // namespace saccade
