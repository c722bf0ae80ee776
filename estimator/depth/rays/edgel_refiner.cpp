#include "estimator/depth/rays/edgel_refiner.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace saccade {
namespace {

constexpr float kMaxResidual_px = 0.5F;  ///< standard deviation of an edgel's events from it
constexpr float kMaxDrift_px = 2.5F;     ///< of an edgel from its seed
constexpr float kSamePlanes = 3;  ///< planes of the sweep within which a nearby seed is the same
constexpr int kSlicesPerStage = 12;
constexpr int kMaxStages = 6;
constexpr float kMinGrowth = 2;  ///< least ratio of the parts of the window from stage to stage
constexpr float kMaxPredictionError_px = 1;
// Change over the window below which the events stay the same; until_converged: below which it has.
constexpr float kSameEvents_px = 0.5F;
constexpr float kConverged_px = 0.1F;
constexpr int kLastIterations = 15;
constexpr double kLastConverged = 0.001;
constexpr float kObservedWeight = 0.5F;  ///< least weight of the events in a slice that observed it
constexpr float kMaxInconsistency = 3;   ///< of own and predicted depth, in standard deviations
constexpr float kSigmaMargin = 2;        ///< on the sigma predicted for the whole window
// What confirms a predicted depth: a sharper edgel, and a gap to other surfaces in own sigmas.
constexpr float kMaxConfirmedResidual_px = 0.4F;
constexpr float kMinGap = 4;

RegressionOptions last_regression(const RefinerOptions& options) {
  RegressionOptions last = options.regression;
  if (options.until_converged) {
    last.iterations = kLastIterations;
    last.converged = kLastConverged;
  }
  return last;
}

std::nullopt_t drop(std::size_t& count) {
  ++count;
  return std::nullopt;
}

/// A part of the window over which a seed is regressed.
struct Stage {
  SliceRange slices;
  float motion_px = 0;  ///< of the edge over it

  [[nodiscard]] bool is_whole(int slice_count) const {
    return slices.first == 0 && slices.last == slice_count && slices.stride == 1;
  }
};

/// Only the whole window is read slice by slice.
Stage stage_over(int first, int last, float motion_px) {
  return {{first, last, std::max(1, (last - first) / kSlicesPerStage)}, motion_px};
}

/// As much more of the window as the depth so far allows: at its ends the predicted position of the
/// edgel must be correct within kMaxPredictionError_px at two standard deviations.
Stage next_stage(const Stage& stage, const RegressionResult& result, float inverse_depth,
                 int slice_count) {
  const int length = stage.slices.last - stage.slices.first;
  const float allowed =
      kMaxPredictionError_px * inverse_depth / (result.sigma * stage.motion_px + 1e-9F);
  const float growth = std::clamp(allowed, kMinGrowth, static_cast<float>(slice_count));
  const int added = std::max(1, static_cast<int>(static_cast<float>(length) * (growth - 1) / 2));
  const int first = std::max(0, stage.slices.first - added);
  const int last = std::min(slice_count, stage.slices.last + added);
  const float motion_px =
      stage.motion_px * static_cast<float>(last - first) / static_cast<float>(length);
  if (first == 0 && last == slice_count) return {{0, slice_count, 1}, motion_px};
  return stage_over(first, last, motion_px);
}

/// Largest relative sigma after this stage with which `max_sigma` can be reached over the whole
/// window: parallax and number of events grow with the part of the window.
float bound_on_sigma(const Stage& stage, int slice_count, double max_sigma) {
  if (stage.is_whole(slice_count)) return static_cast<float>(max_sigma);
  const float growth =
      static_cast<float>(slice_count) / static_cast<float>(stage.slices.last - stage.slices.first);
  const float gain = growth * std::sqrt(growth * static_cast<float>(stage.slices.stride));
  return kSigmaMargin * gain * static_cast<float>(max_sigma);
}

}  // namespace

EdgelRefiner::EdgelRefiner(const EventRays& rays, const RefinerOptions& options,
                           const DepthLimits& limits, const PinholeCamera& camera)
    : rays_(rays),
      options_(options),
      last_(last_regression(options)),
      limits_(limits),
      camera_(camera),
      gatherer_(rays, options.regression.window),
      found_(camera, static_cast<float>(options.spacing_px)) {}

std::optional<FittedEdgel> EdgelRefiner::refine(const EdgelSeed& seed, EdgelEvents& events) {
  Edgel edge{seed.pixel, seed.normal, seed.inverse_depth};
  const SweepPlane& plane = seed.plane;
  if (found_.has_similar(edge, kSamePlanes * plane.spacing)) return std::nullopt;
  const int slices = rays_.slice_count();
  Stage stage = stage_over(plane.first_slice, plane.last_slice, plane.motion_px);
  for (int i = 0; i < kMaxStages; ++i) {
    gatherer_.gather(stage.slices, edge, near_);
    const RegressionResult result =
        regress(near_, stage.is_whole(slices) ? last_ : options_.regression, options_.prior_sigma);
    if (!result.ok) return drop(dropped_.weak);
    if (result.residual_px > kMaxResidual_px) return drop(dropped_.scattered);
    edge = moved(edge, result);
    if (!is_plausible(edge, seed.pixel)) return drop(dropped_.scattered);
    const float sigma = result.sigma / edge.inverse_depth;
    if (sigma > bound_on_sigma(stage, slices, options_.max_sigma)) return drop(dropped_.uncertain);
    if (found_.has_similar(edge, kSameEdgelDepth * edge.inverse_depth)) return std::nullopt;
    const float shift_px = std::abs(result.change) * stage.motion_px / (2 * edge.inverse_depth);
    // What goes on moving by less than would change its events is accepted in the end.
    const bool goes_on = options_.until_converged && i + 1 < kMaxStages;
    if (stage.is_whole(slices) && shift_px < (goes_on ? kConverged_px : kSameEvents_px))
      return accepted(edge, result, events);
    stage = next_stage(stage, result, edge.inverse_depth, slices);
  }
  return drop(dropped_.scattered);
}

std::optional<FittedEdgel> EdgelRefiner::confirm(const Edgel& edge,
                                                 const NeighbourPrediction& prediction,
                                                 EdgelEvents& events) {
  if (found_.has_similar(edge, kSameEdgelDepth * edge.inverse_depth)) return std::nullopt;
  gatherer_.gather({0, rays_.slice_count(), 1}, edge, near_);
  const float prior = 1 / (prediction.sigma * prediction.sigma);
  RegressionResult result = regress(near_, last_, static_cast<double>(prediction.sigma));
  if (!result.ok || result.residual_px > kMaxConfirmedResidual_px) return std::nullopt;
  const Edgel next = moved(edge, result);
  if (!is_plausible(next, edge.pixel)) return std::nullopt;
  if (found_.has_similar(next, kSameEdgelDepth * next.inverse_depth)) return std::nullopt;
  // The information of its events without the prior, and the change that they alone imply.
  const float all = 1 / (result.sigma * result.sigma);
  const float own = std::max(all - prior, 1e-6F * all);
  const float sigma = 1 / std::sqrt(own);
  if (kMinGap * sigma > prediction.gap) return std::nullopt;
  if (std::abs(result.change) * all / own > kMaxInconsistency * std::hypot(sigma, prediction.sigma))
    return std::nullopt;
  result.sigma = std::min(sigma, prediction.max_sigma);
  return accepted(next, result, events);
}

std::optional<FittedEdgel> EdgelRefiner::assume(const EdgelSeed& seed, double relative_sigma,
                                                EdgelEvents& events) {
  constexpr float kAnyDepth = std::numeric_limits<float>::infinity();
  const Edgel edge{seed.pixel, seed.normal, seed.inverse_depth};
  if (found_.has_similar(edge, kAnyDepth)) return std::nullopt;
  gatherer_.gather({seed.plane.first_slice, seed.plane.last_slice, 1}, edge, near_);
  const RegressionResult result =
      regress(near_, options_.regression, relative_sigma * static_cast<double>(edge.inverse_depth));
  if (!result.ok || result.residual_px > kMaxResidual_px) return std::nullopt;
  const Edgel next = moved(edge, result);
  if (!is_plausible(next, edge.pixel) || found_.has_similar(next, kAnyDepth)) return std::nullopt;
  return accepted(next, result, events);
}

FittedEdgel EdgelRefiner::accepted(const Edgel& edge, const RegressionResult& result,
                                   EdgelEvents& events) {
  const std::size_t first = events.event.size();
  append_events(near_, result, events);
  found_.add(edge);
  FittedEdgel fitted{edge, result.sigma, result.residual_px, result.support};
  fitted.first = static_cast<std::uint32_t>(first);
  fitted.last = static_cast<std::uint32_t>(events.event.size());
  fitted.unobserved_px = unobserved_px(events, first);
  return fitted;
}

float EdgelRefiner::unobserved_px(const EdgelEvents& events, std::size_t first) {
  const auto slices = static_cast<std::size_t>(rays_.slice_count());
  observed_.assign(slices, 0.F);
  std::size_t slice = 0;
  for (std::size_t i = first; i < events.event.size(); ++i) {
    while (events.event[i] >= rays_.slice_begin(static_cast<int>(slice) + 1)) ++slice;
    observed_[slice] += events.weight[i];
  }
  const auto reference = static_cast<std::size_t>(rays_.reference_slice());
  const auto& slice_motion_px = gatherer_.slice_motion_px();
  float unobserved = 0;
  for (std::size_t k = reference; k < slices && observed_[k] < kObservedWeight; ++k)
    unobserved += slice_motion_px[k];
  for (std::size_t k = reference; k-- > 0 && observed_[k] < kObservedWeight;)
    unobserved += slice_motion_px[k];
  return unobserved;
}

bool EdgelRefiner::is_plausible(const Edgel& edge, const Eigen::Vector2f& start) const {
  const auto rho = static_cast<double>(edge.inverse_depth);
  return rho >= limits_.min_inverse() && rho <= limits_.max_inverse() &&
         (edge.pixel - start).norm() <= kMaxDrift_px;
}

}  // namespace saccade
