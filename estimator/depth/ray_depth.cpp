#include "estimator/depth/ray_depth.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/image.h"
#include "core/process/parallel.h"
#include "core/stopwatch.h"
#include "estimator/depth/found_edges.h"

namespace saccade {
namespace {

constexpr int kTile_px = 16;
constexpr int kStripTiles = 3;

int tile_of(float px) { return std::max(0, static_cast<int>(px)) / kTile_px; }

/// By tiles, since what is read for one seed is in the cache for the next; edges that are sure come
/// first within a tile, since they keep those beside them away.
SeedStrips in_strips(const std::vector<EdgeSeed>& seeds, int height) {
  std::vector<std::tuple<int, int, float, std::size_t>> order(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i)
    order[i] = {tile_of(seeds[i].pixel.y()), tile_of(seeds[i].pixel.x()), -seeds[i].score, i};
  std::sort(order.begin(), order.end());
  const int strips = tile_of(static_cast<float>(height)) / kStripTiles + 1;
  SeedStrips sorted(static_cast<std::size_t>(strips));
  for (const auto& [row, column, score, index] : order)
    sorted[static_cast<std::size_t>(std::min(row / kStripTiles, strips - 1))].push_back(
        seeds[index]);
  return sorted;
}

/// What a strip adds.
struct StripEdges {
  std::vector<FittedEdge> edges;
  EdgeEvents events;
};

/// Appends what strips found, but for edges that a strip before has found beyond its border.
void append(const std::vector<StripEdges>& strips, FoundEdges found, RayEdges& all) {
  for (const StripEdges& strip : strips)
    for (FittedEdge edge : strip.edges) {
      if (found.holds(edge.edge, EdgeRefiner::kSameDepth * edge.edge.inverse_depth)) continue;
      found.add(edge.edge);
      const auto first = static_cast<std::uint32_t>(all.events.event.size());
      for (std::uint32_t i = edge.first; i < edge.last; ++i) {
        all.events.event.push_back(strip.events.event[i]);
        all.events.weight.push_back(strip.events.weight[i]);
      }
      edge.last = first + (edge.last - edge.first);
      edge.first = first;
      all.edges.push_back(edge);
    }
}

}  // namespace

RayDepth::RayDepth(const RayDepthOptions& options, const DepthLimits& limits,
                   const PinholeCamera& camera)
    : options_(options), limits_(limits), camera_(camera.undistorted()), undistortion_(camera) {}

DepthResult RayDepth::estimate(const ViewWindow& window) const { return fuse(find_edges(window)); }

RayEdges RayDepth::find_edges(const ViewWindow& window) const {
  double rays_s = 0, seeds_s = 0, regression_s = 0, ownership_s = 0, propagation_s = 0;
  const auto timed = [](double& seconds, const auto& step) {
    const ScopedTimer clock(seconds);
    return step();
  };
  RayEdges found;
  const EventRays rays =
      timed(rays_s, [&] { return EventRays(window, camera_, undistortion_, options_.slabs); });
  const SeedStrips strips = timed(seeds_s, [&] {
    const auto seeds = find_seeds(rays, camera_, limits_, options_.seeds);
    for (const EdgeSeed& seed : seeds) found.seeds.push_back(seed.pixel);
    return in_strips(seeds, camera_.height);
  });
  timed(regression_s, [&] { fit(rays, strips, found); });
  const auto own = [&] {
    found.edges = with_own_events(found.edges, found.events, rays.size(), options_.ownership);
  };
  timed(ownership_s, own);
  for (int i = 0; i < options_.propagation.rounds; ++i) {
    timed(propagation_s, [&] { propagate(rays, strips, found); });
    timed(ownership_s, own);
  }
  for (std::uint32_t& event : found.events.event) event = rays.source[event];
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
    const ScopedTimer clock(fusion_s);
    result.points = fused(points_of(found.edges), options_.fusion);
  }
  result.candidates = found.seeds;
  result.stages_s = found.stages_s;
  result.stages_s.emplace_back("fusion", fusion_s);
  return result;
}

void RayDepth::fit(const EventRays& rays, const SeedStrips& strips, RayEdges& found) const {
  std::vector<StripEdges> fitted(strips.size());
  parallel_for(strips.size(), [&](std::size_t k) {
    EdgeRefiner refiner(rays, options_.refiner, limits_, camera_);
    for (const EdgeSeed& seed : strips[k]) {
      if (seed.share < static_cast<float>(options_.propagation.own_share) ||
          seed.strength < static_cast<float>(options_.propagation.own_strength) ||
          seed.parallax_px < static_cast<float>(options_.propagation.own_parallax_px))
        continue;
      if (const auto edge = refiner.refine(seed, fitted[k].events))
        fitted[k].edges.push_back(*edge);
    }
  });
  append(fitted, FoundEdges(camera_, static_cast<float>(options_.refiner.spacing_px)), found);
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

void RayDepth::propagate(const EventRays& rays, const SeedStrips& strips, RayEdges& found) const {
  FoundEdges known(camera_, static_cast<float>(options_.propagation.spacing_px));
  for (const FittedEdge& fitted : found.edges) known.add(fitted.edge);
  const LocalPlanes planes(supported(points_of(found.edges), options_.fusion),
                           options_.propagation.plane);
  std::vector<StripEdges> confirmed(strips.size());
  parallel_for(strips.size(), [&](std::size_t k) {
    EdgeRefiner refiner(rays, options_.refiner, limits_, camera_);
    refiner.restart(known);
    LocalPlanes own_planes = planes;  // fit() keeps its neighbours
    for (const EdgeSeed& seed : strips[k])
      if (const auto edge = confirm(seed, own_planes, refiner, confirmed[k].events))
        confirmed[k].edges.push_back(*edge);
  });
  append(confirmed, std::move(known), found);
}

std::optional<FittedEdge> RayDepth::confirm(const EdgeSeed& seed, LocalPlanes& planes,
                                            EdgeRefiner& refiner, EdgeEvents& events) const {
  const PropagationOptions& options = options_.propagation;
  const float tolerance = static_cast<float>(options.tolerance) * seed.inverse_depth;
  if (refiner.has_found({seed.pixel, seed.normal, seed.inverse_depth}, tolerance))
    return std::nullopt;
  const EdgeDepth* nearest = planes.nearest(seed.pixel.x(), seed.pixel.y());
  if (nearest == nullptr) return std::nullopt;
  if (std::abs(seed.inverse_depth - nearest->inverse_depth) > tolerance) return std::nullopt;
  const LocalPlane plane =
      planes.fit({seed.pixel.x(), seed.pixel.y(), nearest->inverse_depth, nearest->sigma});
  if (plane.weights < static_cast<float>(options.min_neighbours)) return std::nullopt;
  const float model = static_cast<float>(options.plane.model_error) * plane.inverse_depth;
  const Expectation expected{plane.spread * std::hypot(plane.sigma, model),
                             planes.gap_around(seed.pixel.x(), seed.pixel.y(), plane),
                             static_cast<float>(options.min_gap),
                             static_cast<float>(options.max_residual_px),
                             static_cast<float>(options.max_sigma) * plane.inverse_depth};
  return refiner.confirm({seed.pixel, seed.normal, plane.inverse_depth}, expected, events);
}

}  // namespace saccade
