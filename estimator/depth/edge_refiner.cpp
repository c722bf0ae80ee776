#include "estimator/depth/edge_refiner.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace saccade {
namespace {

constexpr float kMaxDrift_px = 2.5F;  ///< of an edge from its seed
constexpr float kSamePlanes = 3;  ///< of the sweep, that an edge nearby with more votes rules out
constexpr int kSlabsOnTheWay = 12;
constexpr int kMaxStages = 6;
constexpr float kMinGrowth = 2;  ///< of the part of the window from stage to stage
constexpr float kMaxBlind_px = 1;
constexpr float kSettled_px = 0.5F;  ///< change over the window after which no event is new
constexpr float kSeen = 0.5F;        ///< weight of the events of a slab that saw the edge
constexpr float kContradiction = 3;  ///< deviations
constexpr float kSigmaSlack = 2;     ///< on what is expected of the whole window

/// A part of the window that a seed's regression looks at.
struct Stage {
  SlabSteps slabs;
  float motion_px = 0;  ///< of the edge over it

  [[nodiscard]] bool is_whole(int slab_count) const {
    return slabs.first == 0 && slabs.last == slab_count && slabs.stride == 1;
  }
};

/// Only the whole window is looked at slab by slab.
Stage stage_over(int first, int last, float motion_px) {
  return {{first, last, std::max(1, (last - first) / kSlabsOnTheWay)}, motion_px};
}

/// As much more of the window as the depth found so far allows: at its ends the edge must be where
/// it is expected, within kMaxBlind_px at two deviations.
Stage next_stage(const Stage& stage, const RegressionResult& result, float inverse_depth,
                 int slab_count) {
  const int length = stage.slabs.last - stage.slabs.first;
  const float allowed = kMaxBlind_px * inverse_depth / (result.sigma * stage.motion_px + 1e-9F);
  const float growth = std::clamp(allowed, kMinGrowth, static_cast<float>(slab_count));
  const int more = std::max(1, static_cast<int>(static_cast<float>(length) * (growth - 1) / 2));
  const int first = std::max(0, stage.slabs.first - more);
  const int last = std::min(slab_count, stage.slabs.last + more);
  const float motion_px =
      stage.motion_px * static_cast<float>(last - first) / static_cast<float>(length);
  if (first == 0 && last == slab_count) return {{0, slab_count, 1}, motion_px};
  return stage_over(first, last, motion_px);
}

/// What sigma may be after this stage, relative, for it to reach `max_sigma` over the whole window:
/// the parallax grows with the part of the window, and so does the number of events.
float bound_on_sigma(const Stage& stage, int slab_count, double max_sigma) {
  if (stage.is_whole(slab_count)) return static_cast<float>(max_sigma);
  const float growth =
      static_cast<float>(slab_count) / static_cast<float>(stage.slabs.last - stage.slabs.first);
  const float gain = growth * std::sqrt(growth * static_cast<float>(stage.slabs.stride));
  return kSigmaSlack * gain * static_cast<float>(max_sigma);
}

}  // namespace

EdgeRefiner::EdgeRefiner(const EventRays& rays, const RefinerOptions& options,
                         const DepthLimits& limits, const PinholeCamera& camera)
    : rays_(rays),
      options_(options),
      limits_(limits),
      camera_(camera),
      gatherer_(rays, options.regression.reach),
      found_(camera, static_cast<float>(options.spacing_px)) {}

std::optional<FittedEdge> EdgeRefiner::refine(const EdgeSeed& seed, EdgeEvents& events) {
  RayEdge edge{seed.pixel, seed.normal, seed.inverse_depth};
  const SweepPlane& plane = seed.plane;
  if (found_.holds(edge, kSamePlanes * plane.step)) return std::nullopt;
  const int slabs = rays_.slab_count();
  Stage stage = stage_over(plane.first_slab, plane.last_slab, plane.motion_px);
  for (int i = 0; i < kMaxStages; ++i) {
    gatherer_.gather(stage.slabs, edge, near_);
    const RegressionResult result = regress(near_, options_.regression);
    if (!result.ok || result.residual_px > static_cast<float>(options_.max_residual_px))
      return std::nullopt;
    edge = moved(edge, result);
    if (!is_plausible(edge, seed.pixel)) return std::nullopt;
    const float sigma = result.sigma / edge.inverse_depth;
    if (sigma > bound_on_sigma(stage, slabs, options_.max_sigma)) return std::nullopt;
    if (found_.holds(edge, kSameDepth * edge.inverse_depth)) return std::nullopt;
    const float shift_px = std::abs(result.change) * stage.motion_px / (2 * edge.inverse_depth);
    if (stage.is_whole(slabs) && shift_px < kSettled_px) return accepted(edge, result, events);
    stage = next_stage(stage, result, edge.inverse_depth, slabs);
  }
  return std::nullopt;
}

std::optional<FittedEdge> EdgeRefiner::confirm(const RayEdge& edge, const Expectation& expected,
                                               EdgeEvents& events) {
  if (found_.holds(edge, kSameDepth * edge.inverse_depth)) return std::nullopt;
  gatherer_.gather({0, rays_.slab_count(), 1}, edge, near_);
  const float prior = 1 / (expected.sigma * expected.sigma);
  RegressionResult result =
      regress(near_, options_.regression, static_cast<double>(expected.sigma));
  if (!result.ok || result.residual_px > expected.max_residual_px) return std::nullopt;
  const RayEdge next = moved(edge, result);
  if (!is_plausible(next, edge.pixel)) return std::nullopt;
  if (found_.holds(next, kSameDepth * next.inverse_depth)) return std::nullopt;
  // The information of its events alone, and the change that they alone ask for.
  const float all = 1 / (result.sigma * result.sigma);
  const float own = std::max(all - prior, 1e-6F * all);
  const float sigma = 1 / std::sqrt(own);
  if (expected.min_gap * sigma > expected.gap) return std::nullopt;
  if (std::abs(result.change) * all / own > kContradiction * std::hypot(sigma, expected.sigma))
    return std::nullopt;
  result.sigma = std::min(sigma, expected.max_sigma);
  return accepted(next, result, events);
}

FittedEdge EdgeRefiner::accepted(const RayEdge& edge, const RegressionResult& result,
                                 EdgeEvents& events) {
  const std::size_t first = events.event.size();
  append_events(near_, result, events);
  found_.add(edge);
  FittedEdge fitted{edge, result.sigma, result.residual_px, result.support};
  fitted.first = static_cast<std::uint32_t>(first);
  fitted.last = static_cast<std::uint32_t>(events.event.size());
  fitted.unseen_px = unseen_px(events, first);
  return fitted;
}

float EdgeRefiner::unseen_px(const EdgeEvents& events, std::size_t first) {
  const auto slabs = static_cast<std::size_t>(rays_.slab_count());
  seen_.assign(slabs, 0.F);
  std::size_t slab = 0;
  for (std::size_t i = first; i < events.event.size(); ++i) {
    while (events.event[i] >= rays_.slab_begin(static_cast<int>(slab) + 1)) ++slab;
    seen_[slab] += events.weight[i];
  }
  const auto reference = static_cast<std::size_t>(rays_.reference_slab());
  const auto& crossing_px = gatherer_.crossing_px();
  float unseen = 0;
  for (std::size_t k = reference; k < slabs && seen_[k] < kSeen; ++k) unseen += crossing_px[k];
  for (std::size_t k = reference; k-- > 0 && seen_[k] < kSeen;) unseen += crossing_px[k];
  return unseen;
}

bool EdgeRefiner::is_plausible(const RayEdge& edge, const Eigen::Vector2f& start) const {
  const auto rho = static_cast<double>(edge.inverse_depth);
  return rho >= limits_.min_inverse() && rho <= limits_.max_inverse() &&
         (edge.pixel - start).norm() <= kMaxDrift_px;
}

}  // namespace saccade
