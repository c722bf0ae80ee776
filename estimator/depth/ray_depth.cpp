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

constexpr float kMaxDrift_px = 2.5F;  ///< of an edge from its seed
constexpr float kSameDepth = 0.01F;
constexpr float kSamePlanes = 3;  ///< of the sweep, that an edge nearby with more votes rules out
constexpr int kTile_px = 16;
constexpr int kGrowth = 3;
constexpr int kSlabsOnTheWay = 12;

/// By tiles, since what is read for one seed is in the cache for the next; edges that are sure come
/// first within a tile, since they keep those beside them away.
void sort_seeds(std::vector<EdgeSeed>& seeds) {
  const auto tile = [](const EdgeSeed& seed) {
    return std::pair(static_cast<int>(seed.pixel.y()) / kTile_px,
                     static_cast<int>(seed.pixel.x()) / kTile_px);
  };
  std::stable_sort(seeds.begin(), seeds.end(), [&](const EdgeSeed& a, const EdgeSeed& b) {
    return std::tuple(tile(a), -a.score) < std::tuple(tile(b), -b.score);
  });
}

/// The parts of the window used by a seed's regressions: the sweep's, each time `kGrowth` as long,
/// and the whole; only the last looks at every slab.
std::vector<SlabSteps> stages_of(const SweepPlane& plane, int slabs) {
  std::vector<SlabSteps> stages;
  const auto add = [&](int first, int last) {
    stages.push_back({first, last, std::max(1, (last - first) / kSlabsOnTheWay)});
  };
  add(plane.first_slab, plane.last_slab);
  while (stages.back().first > 0 || stages.back().last < slabs) {
    const auto [first, last, stride] = stages.back();
    const int grow = std::max(1, (last - first) * (kGrowth - 1) / 2);
    add(std::max(0, first - grow), std::min(slabs, last + grow));
  }
  stages.push_back({0, slabs, 1});
  return stages;
}

/// Where edges were found already, by pixel.
class FoundEdges {
 public:
  FoundEdges(const PinholeCamera& camera, float spacing_px)
      : cells_(camera.width, camera.height), spacing_px_(spacing_px) {}

  void add(const RayEdge& edge) {
    const auto [x, y] = cell_of(edge.pixel);
    cells_(x, y).push_back(edge);
  }
  /// Another edge nearby, its inverse depth nearer than `tolerance`.
  [[nodiscard]] bool holds(const RayEdge& edge, float tolerance) const {
    const auto [cx, cy] = cell_of(edge.pixel);
    const int reach = static_cast<int>(std::ceil(spacing_px_));
    for (int y = std::max(cy - reach, 0); y <= std::min(cy + reach, cells_.height() - 1); ++y)
      for (int x = std::max(cx - reach, 0); x <= std::min(cx + reach, cells_.width() - 1); ++x)
        for (const RayEdge& other : cells_(x, y))
          if ((other.pixel - edge.pixel).squaredNorm() < spacing_px_ * spacing_px_ &&
              other.normal.dot(edge.normal) > 0.5F &&
              std::abs(other.inverse_depth - edge.inverse_depth) <= tolerance)
            return true;
    return false;
  }

 private:
  [[nodiscard]] std::pair<int, int> cell_of(const Eigen::Vector2f& pixel) const {
    const auto clamped = [](float px, int size) {
      return std::clamp(static_cast<int>(std::lround(px)), 0, size - 1);
    };
    return {clamped(pixel.x(), cells_.width()), clamped(pixel.y(), cells_.height())};
  }

  Image<std::vector<RayEdge>> cells_;
  float spacing_px_;
};

class SeedRefiner {
 public:
  SeedRefiner(const EventRays& rays, const RayDepthOptions& options, const DepthLimits& limits,
              const PinholeCamera& camera)
      : rays_(rays),
        options_(options),
        limits_(limits),
        found_(camera, static_cast<float>(options.spacing_px)) {}

  /// Appends the events of the edge to `events`; nullopt where no edge was found.
  std::optional<FittedEdge> refine(const EdgeSeed& seed, EdgeEvents& events) {
    RayEdge edge{seed.pixel, seed.normal, seed.inverse_depth};
    RegressionResult result;
    if (found_.holds(edge, kSamePlanes * seed.plane.step)) return std::nullopt;
    for (const SlabSteps& stage : stages_of(seed.plane, rays_.slab_count())) {
      gather_rays(rays_, stage, edge, options_.regression, near_);
      result = regress(near_, options_.regression);
      if (!result.ok || result.residual_px > static_cast<float>(options_.max_residual_px))
        return std::nullopt;
      edge = moved(edge, result);
      if (!is_plausible(edge, seed)) return std::nullopt;
      if (found_.holds(edge, kSameDepth * edge.inverse_depth)) return std::nullopt;
    }
    FittedEdge fitted{edge, result.sigma, result.residual_px, result.support, 0, 0};
    if (fitted.sigma > static_cast<float>(options_.max_sigma) * edge.inverse_depth)
      return std::nullopt;
    found_.add(edge);
    fitted.first = static_cast<std::uint32_t>(events.event.size());
    const std::vector<float> weights = weights_of(near_, result);
    for (std::size_t i = 0; i < near_.count; ++i) {
      if (!(weights[i] > 0)) continue;
      events.event.push_back(near_.event[i]);
      events.weight.push_back(weights[i]);
    }
    fitted.last = static_cast<std::uint32_t>(events.event.size());
    return fitted;
  }

 private:
  [[nodiscard]] bool is_plausible(const RayEdge& edge, const EdgeSeed& seed) const {
    const auto rho = static_cast<double>(edge.inverse_depth);
    return rho >= limits_.min_inverse() && rho <= limits_.max_inverse() &&
           (edge.pixel - seed.pixel).norm() <= kMaxDrift_px;
  }

  const EventRays& rays_;
  const RayDepthOptions& options_;
  const DepthLimits& limits_;
  FoundEdges found_;
  RayNeighbourhood near_;
};

}  // namespace

RayDepth::RayDepth(const RayDepthOptions& options, const DepthLimits& limits,
                   const PinholeCamera& camera)
    : options_(options), limits_(limits), camera_(camera.undistorted()), undistortion_(camera) {}

DepthResult RayDepth::estimate(const DepthWindow& window) const {
  double rays_s = 0, seeds_s = 0, regression_s = 0, ownership_s = 0, fusion_s = 0;
  const auto timed = [](double& seconds, const auto& step) {
    const StageClock clock(seconds);
    return step();
  };
  DepthResult result;
  const EventRays rays =
      timed(rays_s, [&] { return EventRays(window, camera_, undistortion_, options_.slabs); });
  auto seeds = timed(seeds_s, [&] { return find_seeds(rays, camera_, limits_, options_.seeds); });
  sort_seeds(seeds);
  EdgeEvents events;
  auto edges = timed(regression_s, [&] { return fit(rays, seeds, events); });
  edges = timed(ownership_s,
                [&] { return with_own_events(edges, events, rays.size(), options_.ownership); });
  std::vector<EdgeDepth> points;
  for (const FittedEdge& e : edges)
    if (camera_.contains(e.edge.pixel.cast<double>()))
      points.push_back({e.edge.pixel.x(), e.edge.pixel.y(), e.edge.inverse_depth, e.sigma});
  result.points = timed(fusion_s, [&] { return fused(points, options_.fusion); });
  for (const EdgeSeed& seed : seeds) result.candidates.push_back(seed.pixel);
  result.stages_s = {{"rays", rays_s},
                     {"seeds", seeds_s},
                     {"regression", regression_s},
                     {"ownership", ownership_s},
                     {"fusion", fusion_s}};
  return result;
}

std::vector<FittedEdge> RayDepth::fit(const EventRays& rays, const std::vector<EdgeSeed>& seeds,
                                      EdgeEvents& events) const {
  if (seeds.empty()) return {};
  SeedRefiner refiner(rays, options_, limits_, camera_);
  std::vector<FittedEdge> edges;
  for (const EdgeSeed& seed : seeds)
    if (const auto edge = refiner.refine(seed, events)) edges.push_back(*edge);
  return edges;
}

}  // namespace saccade
