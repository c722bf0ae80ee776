#include "estimator/depth/rays/ray_depth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

#include "core/image.h"
#include "core/process/parallel.h"
#include "core/stopwatch.h"
#include "estimator/depth/rays/edgel_index.h"
#include "estimator/depth/rays/stream_delay.h"

namespace saccade {
namespace {

constexpr int kTile_px = 16;
constexpr int kStripTiles = 3;
/// Hundreds of edgels tell the delay of events to microseconds.
constexpr std::size_t kDelaySeeds = 1000;

// Seeds that are refined on their own; weaker ones, those with less parallax and those off the best
// plane of their pixel need neighbours that predict their depth.
constexpr float kMinStrength = 1.6F;
constexpr float kMinVoteRatio = 1;
constexpr float kMinParallax_px = 1.2F;
/// An edgel is dropped when less than this fraction of its events is explained by it better than by
/// others.
constexpr double kMinOwnEventFraction = 0.9;
/// An edgel that moves farther than this without an event around the time of the view was hidden
/// then, and is no point of the view.
constexpr float kMaxUnobserved_px = 2;
// The neighbours that predict a depth.
constexpr PlaneOptions kPropagationPlane{.radius_px = 10};
constexpr float kPropagationSpacing_px = 1;  ///< between edgels at the same depth
constexpr float kMinNeighbours = 4;          ///< least sum of weights of a plane
constexpr float kDepthTolerance = 0.15F;  ///< relative, between a seed's depth and the nearest one
constexpr float kManyNeighbours = 10;     ///< the same where the seed has another depth than they

/// Relative: however far the gates are opened, a worse depth does not tell near from far.
constexpr double kLargestSigma = 0.2;

int tile_of(float px) { return std::max(0, static_cast<int>(px)) / kTile_px; }

/// By tiles, since neighbouring seeds read the same events; the strongest come first within a tile,
/// since an edgel suppresses its neighbours.
SeedStrips sorted_into_strips(const std::vector<EdgelSeed>& seeds, int height) {
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

/// The gate that keeps a seed from being refined on its own; nullptr: none.
std::size_t GateCounts::*gate_of(const EdgelSeed& seed, double opening) {
  const float least_strength = opening > 1 ? 1 : kMinStrength;
  if (seed.vote_ratio < kMinVoteRatio || seed.strength < least_strength) return &GateCounts::weak;
  if (seed.parallax_px < kMinParallax_px / static_cast<float>(opening)) return &GateCounts::still;
  return nullptr;
}

bool has_depth_of(const EdgePoint& point, const EdgelSeed& seed) {
  return std::abs(seed.inverse_depth - point.inverse_depth) <= kDepthTolerance * seed.inverse_depth;
}

/// Of those that pass the gates `count` to twice as many where there are so many, of each strip a share by its number.
SeedStrips some_of(const SeedStrips& strips, double opening, std::size_t count) {
  SeedStrips passing(strips.size());
  std::size_t all = 0;
  for (std::size_t k = 0; k < strips.size(); ++k) {
    std::ranges::copy_if(strips[k], std::back_inserter(passing[k]),
                         [&](const EdgelSeed& seed) { return gate_of(seed, opening) == nullptr; });
    all += passing[k].size();
  }
  const std::size_t step = std::max<std::size_t>(1, all / count);
  for (auto& strip : passing) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < strip.size(); i += step) strip[kept++] = strip[i];
    strip.resize(kept);
  }
  return passing;
}

/// Appends the edgels of the strips, without those that an earlier strip found beyond its border.
void append(const std::vector<WindowEdgels>& strips, EdgelIndex found, WindowEdgels& all) {
  for (const WindowEdgels& strip : strips)
    for (FittedEdgel edge : strip.edges) {
      if (found.has_similar(edge.edge, EdgelRefiner::kSameEdgelDepth * edge.edge.inverse_depth))
        continue;
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

void describe(config::Fields& fields, RayDepthOptions& options) {
  fields
      .value("spacing_px", options.refiner.spacing_px,
             "Smallest distance between edgels at the same depth, in pixels; smaller values give "
             "denser points whose errors are more correlated, at a higher cost.")
      .range(0, 20);
  fields
      .value("max_sigma", options.refiner.max_sigma,
             "Edgels whose inverse depth has a larger standard deviation, divided by the inverse "
             "depth, are dropped; larger values give more and less accurate edgels. Which of them "
             "become points the planes through them decide (fusion.max_sigma).")
      .above(0);
  fields
      .value("least_points", options.least_points,
             "A view with fewer points is estimated again with its gates of parallax and sigma "
             "opened by 3, then by 10 (never beyond a sigma of 0.2), and the run says so; 0 keeps "
             "the gates as they are.")
      .range(0, 1e6);
  fields.value("find_delay", options.find_delay,
               "Finds by how much the events of each window come later than the poses say, and "
               "takes it out: the delay of "
               "pixels and readout, and the difference of two clocks. Only motion that is not "
               "uniform tells it. false: they "
               "come in time, as they do where the poses were made of the same events.");
  fields.section("fusion", options.fusion, "Planes fitted through neighbouring points.");
}

RayDepth::RayDepth(const RayDepthOptions& options, const DepthLimits& limits,
                   const PinholeCamera& camera)
    : options_(options), limits_(limits), camera_(camera.undistorted()), undistortion_(camera) {}

RayDepthOptions RayDepthOptions::for_given_poses() const {
  RayDepthOptions options = *this;
  options.refiner.until_converged = true;
  options.fills = true;
  options.fusion.widens = true;
  return options;
}

RayDepthOptions RayDepthOptions::with_larger_sigmas(double factor) const {
  RayDepthOptions options = *this;
  options.refiner.max_sigma *= factor;
  options.propagation_max_sigma *= factor;
  options.fusion.max_sigma *= factor;
  return options;
}

RayDepthOptions RayDepthOptions::opened(double opening, const DepthLimits& limits) const {
  const auto open = [&](double sigma) {
    return std::max(sigma, std::min(opening * sigma, kLargestSigma));
  };
  RayDepthOptions options = *this;
  options.gate_opening = opening;
  options.refiner.max_sigma = open(refiner.max_sigma);
  // All depths within the limits: it holds the first stages, which see hardly any parallax.
  options.refiner.prior_sigma = limits.max_inverse();
  options.propagation_max_sigma = open(propagation_max_sigma);
  options.fusion.max_sigma = open(fusion.max_sigma);
  return options;
}

float PoseError::sigma_of(const FittedEdgel& edgel) const {
  const float moved_px = std::hypot(rotation_px, position_px_m * edgel.edge.inverse_depth);
  // Events of an ideal sensor may lie on one line exactly.
  constexpr float kLeastResidual_px = 0.01F;
  return edgel.sigma * std::sqrt(edgel.support) * moved_px /
         std::max(edgel.residual_px, kLeastResidual_px);
}

DepthResult RayDepth::estimate(const ViewWindow& window) const {
  std::vector<std::pair<std::string, double>> stages_s;
  DepthResult result = with_open_gates<DepthResult>(
      [&](const RayDepth& opened) {
        DepthResult found = opened.fuse(opened.find_delayed_edgels(window));
        // The time of all passes, whichever is taken.
        if (stages_s.empty())
          stages_s = found.stages_s;
        else
          for (std::size_t k = 0; k < stages_s.size(); ++k)
            stages_s[k].second += found.stages_s[k].second;
        return found;
      },
      [](const DepthResult& found) { return found.points.size(); });
  result.stages_s = std::move(stages_s);
  return result;
}

std::size_t RayDepth::enough_points() const {
  constexpr std::size_t kPixelsPerPoint = 100;  ///< of what a small sensor is asked for
  const auto pixels =
      static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
  return std::min(static_cast<std::size_t>(options_.least_points), pixels / kPixelsPerPoint);
}

WindowEdgels RayDepth::find_edgels(const ViewWindow& window) const {
  return find_edgels(window, false);
}

WindowEdgels RayDepth::find_delayed_edgels(const ViewWindow& window) const {
  return find_edgels(window, options_.find_delay);
}

WindowEdgels RayDepth::find_edgels(const ViewWindow& window, bool may_be_delayed) const {
  double rays_s = 0, seeds_s = 0, regression_s = 0, assignment_s = 0, propagation_s = 0;
  const auto timed = [](double& seconds, const auto& stage) {
    const ScopedTimer clock(seconds);
    return stage();
  };
  WindowEdgels found;
  found.pose_error = pose_error_over(window);
  EventRays rays = timed(rays_s, [&] {
    return EventRays(window, camera_, undistortion_, RayDepthOptions::kTimeSlices);
  });
  const SeedStrips strips = timed(seeds_s, [&] {
    const FoundSeeds swept =
        find_seeds(rays, camera_, limits_, kSeedParallax_px / options_.gate_opening);
    found.dropped.still = swept.still;
    std::vector<EdgelSeed> seeds = swept.seeds;
    // So little motion that the sweep does not tell the planes apart: all edges, at any depth.
    if (options_.gate_opening > 1) {
      const std::vector<EdgelSeed> more =
          find_seeds_at(rays, camera_, (limits_.min_inverse() + limits_.max_inverse()) / 2, 1);
      seeds.insert(seeds.end(), more.begin(), more.end());
    }
    for (const EdgelSeed& seed : seeds) found.seeds.push_back(seed.pixel);
    return sorted_into_strips(seeds, camera_.height);
  });
  if (may_be_delayed) {
    found.delay = timed(regression_s, [&] { return find_delay(window, strips, rays); });
  }
  timed(regression_s, [&] { refine_seeds(rays, strips, found); });
  const auto assign = [&] {
    const std::size_t before = found.edges.size();
    found.edges = assign_events(found.edges, found.events, rays.size(), kMinOwnEventFraction);
    found.dropped.foreign += before - found.edges.size();
  };
  timed(assignment_s, assign);
  timed(propagation_s, [&] { propagate(rays, strips, found); });
  timed(assignment_s, assign);
  found.first_assumed = found.edges.size();
  if (options_.assumed_inverse_depth) timed(propagation_s, [&] { assume(rays, found); });
  for (std::uint32_t& event : found.events.event) event = rays.source[event];
  found.stages_s = {{"rays", rays_s},
                    {"seeds", seeds_s},
                    {"regression", regression_s},
                    {"assignment", assignment_s},
                    {"propagation", propagation_s}};
  return found;
}

DepthResult RayDepth::fuse(const WindowEdgels& found) const {
  double fusion_s = 0;
  DepthResult result;
  {
    const ScopedTimer clock(fusion_s);
    const std::vector<EdgePoint> points = points_of(found);
    result.points = fuse_planes(points, options_.fusion);
    if (result.points.empty()) {
      GateCounts dropped = found.dropped;
      const std::vector<EdgePoint> supported = supported_points(points, options_.fusion);
      dropped.hidden += found.edges.size() - points.size();
      dropped.alone += points.size() - supported.size();
      for (const EdgePoint& point : supported)
        ++(point.pose_sigma > static_cast<float>(options_.fusion.max_sigma) * point.inverse_depth
               ? dropped.jittered
               : dropped.uncertain);
      result.why_empty = main_gate(dropped);
    }
  }
  result.gate_opening = options_.gate_opening;
  result.event_delay_s = found.delay.delay_s;
  result.candidates = found.seeds;
  result.stages_s = found.stages_s;
  result.stages_s.emplace_back("fusion", fusion_s);
  return result;
}

StreamDelay RayDepth::find_delay(const ViewWindow& window, const SeedStrips& strips,
                                 EventRays& rays) const {
  // A round leaves a fifth of the delay, since events that lie beside their edge count less.
  constexpr int kRounds = 3;
  // Moves an edge by a hundredth of a pixel at 500 px/s.
  constexpr double kNoChange_s = 2e-5;
  // Beyond, rays do not follow their rates.
  constexpr double kLinear_s = 1e-3;
  const SeedStrips some = some_of(strips, options_.gate_opening, kDelaySeeds);
  ViewWindow delayed = window;
  StreamDelay delay;
  for (int round = 0; round < kRounds; ++round) {
    WindowEdgels found;
    refine_seeds(rays, some, found);
    const StreamDelay more = estimate_delay(rays, window.events, found.edges, found.events);
    const StreamDelay next = StreamDelay{delay.delay_s + more.delay_s, more.sigma_s}.with_prior();
    const double change_s = next.delay_s - delay.delay_s;
    if (std::abs(change_s) < kNoChange_s) break;
    delay = next;
    delayed.event_delay_s = delay.delay_s;
    if (std::abs(delay.delay_s) < kLinear_s)
      rays.take_out(change_s, delayed, camera_);
    else
      rays = EventRays(delayed, camera_, undistortion_, RayDepthOptions::kTimeSlices);
  }
  return delay;
}

void RayDepth::refine_seeds(const EventRays& rays, const SeedStrips& strips,
                            WindowEdgels& found) const {
  std::vector<WindowEdgels> fitted(strips.size());
  parallel_for(strips.size(), [&](std::size_t k) {
    EdgelRefiner refiner(rays, options_.refiner, limits_, camera_);
    GateCounts& dropped = fitted[k].dropped;
    for (const EdgelSeed& seed : strips[k]) {
      if (std::size_t GateCounts::*const gate = gate_of(seed, options_.gate_opening))
        ++(dropped.*gate);
      else if (const auto edge = refiner.refine(seed, fitted[k].events))
        fitted[k].edges.push_back(*edge);
    }
    dropped += refiner.dropped();
  });
  for (const WindowEdgels& strip : fitted) found.dropped += strip.dropped;
  append(fitted, EdgelIndex(camera_, static_cast<float>(options_.refiner.spacing_px)), found);
}

void RayDepth::assume(const EventRays& rays, WindowEdgels& found) const {
  EdgelIndex known(camera_, static_cast<float>(options_.refiner.spacing_px));
  for (const FittedEdgel& fitted : found.edges) known.add(fitted.edge);
  const SeedStrips strips = sorted_into_strips(
      find_seeds_at(rays, camera_, *options_.assumed_inverse_depth, RayDepthOptions::kAssumedSigma),
      camera_.height);
  std::vector<WindowEdgels> assumed(strips.size());
  parallel_for(strips.size(), [&](std::size_t k) {
    EdgelRefiner refiner(rays, options_.refiner, limits_, camera_);
    refiner.restart(known);
    for (const EdgelSeed& seed : strips[k]) {
      if (seed.strength < kMinStrength) continue;
      if (const auto edge = refiner.assume(seed, RayDepthOptions::kAssumedSigma, assumed[k].events))
        assumed[k].edges.push_back(*edge);
    }
  });
  append(assumed, std::move(known), found);
}

PoseError RayDepth::pose_error_over(const ViewWindow& window) const {
  if (window.events.empty()) return {};
  const double duration_s = seconds_from_ns(window.events.back().t_ns - window.events.front().t_ns);
  const double scale_px = camera_.fx / std::sqrt(window.pose_noise.poses_within(duration_s));
  return {static_cast<float>(scale_px * window.pose_noise.rotation_rad),
          static_cast<float>(scale_px * window.pose_noise.position_m)};
}

std::vector<EdgePoint> RayDepth::points_of(const WindowEdgels& found) const {
  std::vector<EdgePoint> points;
  for (const FittedEdgel& e : found.edges)
    if (!options_.is_assumed(e) && e.unobserved_px <= kMaxUnobserved_px &&
        camera_.contains(e.edge.pixel.cast<double>()))
      points.push_back({e.edge.pixel.x(), e.edge.pixel.y(), e.edge.inverse_depth, e.sigma,
                        e.edge.normal, found.pose_error.sigma_of(e)});
  return points;
}

void RayDepth::propagate(const EventRays& rays, const SeedStrips& strips,
                         WindowEdgels& found) const {
  EdgelIndex known(camera_, kPropagationSpacing_px);
  for (const FittedEdgel& fitted : found.edges) known.add(fitted.edge);
  const LocalPlanes planes(supported_points(points_of(found), options_.fusion), kPropagationPlane);
  // Of the seeds of a cell of one pixel whose depth is another than their neighbours' the strongest alone is tried at
  // theirs. Cells begin at whole pixels as the tiles of the strips do (tile_of()), so that no two strips share a row.
  Image<std::uint8_t> is_tried(camera_.width, camera_.height);
  std::vector<WindowEdgels> confirmed(strips.size());
  parallel_for(strips.size(), [&](std::size_t k) {
    EdgelRefiner refiner(rays, options_.refiner, limits_, camera_);
    refiner.restart(known);
    LocalPlanes own_planes = planes;  // fit() is not thread-safe
    for (const EdgelSeed& seed : strips[k]) {
      const EdgePoint* nearest = own_planes.nearest(seed.pixel.x(), seed.pixel.y());
      if (nearest == nullptr) continue;
      if (!has_depth_of(*nearest, seed)) {
        if (!options_.fills) continue;
        std::uint8_t& tried =
            is_tried(static_cast<int>(seed.pixel.x()), static_cast<int>(seed.pixel.y()));
        if (std::exchange(tried, 1) != 0) continue;
      }
      if (const auto edge = confirm(seed, *nearest, own_planes, refiner, confirmed[k].events))
        confirmed[k].edges.push_back(*edge);
    }
  });
  append(confirmed, std::move(known), found);
}

std::optional<FittedEdgel> RayDepth::confirm(const EdgelSeed& seed, const EdgePoint& nearest,
                                             LocalPlanes& planes, EdgelRefiner& refiner,
                                             EdgelEvents& events) const {
  const bool is_of_plane = has_depth_of(nearest, seed);
  const float expected = is_of_plane ? seed.inverse_depth : nearest.inverse_depth;
  if (refiner.has_similar({seed.pixel, seed.normal, expected}, kDepthTolerance * expected))
    return std::nullopt;
  const LocalPlane plane =
      planes.fit({seed.pixel.x(), seed.pixel.y(), nearest.inverse_depth, nearest.sigma});
  if (plane.weights < kMinNeighbours) return std::nullopt;
  const float gap = planes.gap_around(seed.pixel.x(), seed.pixel.y(), plane);
  if (!is_of_plane) {
    const bool is_inside = plane.weights >= kManyNeighbours && planes.surrounds_start(plane);
    if (!is_inside || std::isfinite(gap)) return std::nullopt;
  }
  const float model = static_cast<float>(kPropagationPlane.model_error) * plane.inverse_depth;
  const NeighbourPrediction prediction{
      plane.spread * std::hypot(plane.sigma, model), gap,
      static_cast<float>(options_.propagation_max_sigma) * plane.inverse_depth};
  return refiner.confirm({seed.pixel, seed.normal, plane.inverse_depth}, prediction, events);
}

}  // namespace saccade
