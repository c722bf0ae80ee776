#include "estimator/depth/rays/edgel_refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::PlanarWorld;
using testing::trajectory_of;

constexpr double kRefinedEnd_s = 0.3;
constexpr double kMiddle_s = kRefinedEnd_s / 2;

struct GlideRecording {
  PlanarWorld world = corner_world(160, 120);
  Trajectory poses = trajectory_of(corner_glide, kRefinedEnd_s);
  Events events = world.simulate(corner_glide, 0, kRefinedEnd_s, 1e-3, 0.15);
  ImageF depth = world.depth(corner_glide(kMiddle_s));
  UndistortionTable undistortion{world.camera()};

  /// The smallest relative error within the 3 x 3 pixels.
  [[nodiscard]] double error_of(const Edgel& edge) const {
    const auto x = static_cast<int>(std::lround(edge.pixel.x()));
    const auto y = static_cast<int>(std::lround(edge.pixel.y()));
    double best = 1e9;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth.height() - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth.width() - 1); ++u)
        if (depth(u, v) > 0)
          best = std::min(best, std::abs(1 / static_cast<double>(edge.inverse_depth) /
                                             static_cast<double>(depth(u, v)) -
                                         1));
    return best;
  }
};

const GlideRecording& glide_recording() {
  static const GlideRecording recording;
  return recording;
}

/// All edgels refined from seeds.
struct Refined {
  EventRays rays;
  EdgelRefiner refiner;
  std::vector<EdgelSeed> seeds;
  std::vector<FittedEdgel> edges;
  EdgelEvents events;

  explicit Refined(std::span<const Event> of, const RefinerOptions& options = kOptions)
      : rays({of, &glide_recording().poses, kMiddle_s}, glide_recording().world.camera(),
             glide_recording().undistortion, 32),
        refiner(rays, options, {}, glide_recording().world.camera()),
        seeds(find_seeds(rays, glide_recording().world.camera(), {}).seeds) {
    for (const EdgelSeed& seed : seeds)
      if (const auto edge = refiner.refine(seed, events)) edges.push_back(*edge);
  }
  /// Without the uncertain ones that neighbours make points of.
  static inline const RefinerOptions kOptions = [] {
    RefinerOptions options;
    options.max_sigma = 0.015;
    return options;
  }();
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

TEST(EdgelRefiner, SeedsLeadToTheTrueDepth) {
  const Refined refined(glide_recording().events);
  ASSERT_GT(refined.edges.size(), 300U);
  std::vector<double> seeds, edges;
  for (const EdgelSeed& seed : refined.seeds)
    seeds.push_back(glide_recording().error_of({seed.pixel, seed.normal, seed.inverse_depth}));
  for (const FittedEdgel& fitted : refined.edges)
    edges.push_back(glide_recording().error_of(fitted.edge));
  EXPECT_LT(median(edges), 0.005);
  EXPECT_LT(median(edges), median(seeds) / 5);
}

/// By how much a further regression over the whole window would change the edgels' depths, in the
/// median, in their sigmas.
double change_left(const RefinerOptions& options) {
  Refined found(glide_recording().events, options);
  RayGatherer gatherer(found.rays, options.regression.window);
  RayNeighbourhood near;
  std::vector<double> left;
  for (const FittedEdgel& fitted : found.edges) {
    gatherer.gather({0, found.rays.slice_count(), 1}, fitted.edge, near);
    RegressionOptions endless = options.regression;
    endless.iterations = 100;
    endless.converged = 0;
    left.push_back(std::abs(static_cast<double>(regress(near, endless).change) /
                            static_cast<double>(fitted.sigma)));
  }
  return median(left);
}

TEST(EdgelRefiner, GoesOnUntilItHasConvergedWhereItIsAskedTo) {
  RefinerOptions options;
  const double early = change_left(options);
  options.until_converged = true;
  EXPECT_LT(2 * change_left(options), early);
}

TEST(EdgelRefiner, AnAssumedDepthIsKeptWithinItsSigma) {
  const Refined refined(glide_recording().events);
  const PinholeCamera& camera = glide_recording().world.camera();
  const double inverse = 1 / testing::kCornerDepth_m;
  const std::vector<EdgelSeed> seeds = find_seeds_at(refined.rays, camera, inverse, 0.5);
  ASSERT_GT(seeds.size(), 300U);
  // By so little of the window that half of the inverse depth moves nothing by more than a pixel:
  // the glide moves points at the typical depth by 12 px in a tenth of a second.
  EXPECT_LT(seeds[0].plane.last_slice - seeds[0].plane.first_slice, refined.rays.slice_count() / 3);
  EdgelRefiner refiner(refined.rays, Refined::kOptions, {}, camera);
  EdgelEvents events;
  std::size_t count = 0, far = 0;
  for (const EdgelSeed& seed : seeds)
    if (const auto edge = refiner.assume(seed, 0.5, events)) {
      ++count;
      // A prior of half of it, with what these events add, which is little.
      EXPECT_LT(edge->sigma, 0.6F * seed.inverse_depth);
      if (std::abs(edge->edge.inverse_depth - seed.inverse_depth) > seed.inverse_depth) ++far;
      EXPECT_FALSE(refiner.assume(seed, 0.5, events)) << "there is one already";
    }
  EXPECT_GT(count, 150U);
  EXPECT_LT(far, count / 20) << "beyond two of its standard deviations";
}

TEST(EdgelRefiner, EdgesKeepTheirDistance) {
  RefinerOptions options;
  options.spacing_px = 3;
  const Refined refined(glide_recording().events, options);
  ASSERT_GT(refined.edges.size(), 100U);
  for (std::size_t i = 0; i < refined.edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Edgel &a = refined.edges[i].edge, &b = refined.edges[j].edge;
      const bool is_same = a.normal.dot(b.normal) > 0.5F &&
                           std::abs(a.inverse_depth - b.inverse_depth) < 0.005F * a.inverse_depth;
      EXPECT_FALSE(is_same && (a.pixel - b.pixel).norm() < 3);
    }
}

TEST(EdgelRefiner, EdgelsWithoutEventsAroundTheViewAreUnobserved) {
  std::vector<Event> without;
  for (const Event& event : glide_recording().events)
    if (std::abs(seconds_from_ns(event.t_ns) - kMiddle_s) > 0.075) without.push_back(event);
  const auto unobserved = [](const Refined& refined) {
    std::vector<double> px;
    for (const FittedEdgel& edge : refined.edges)
      px.push_back(static_cast<double>(edge.unobserved_px));
    return median(px);
  };
  EXPECT_LT(unobserved(Refined(glide_recording().events)), 1.5);
  EXPECT_GT(unobserved(Refined(without)), 2.5);
}

TEST(EdgelRefiner, ConfirmsAnExpectedDepthButNoOther) {
  Refined refined(glide_recording().events);
  const std::vector<FittedEdgel> edges = refined.edges;
  const auto confirmed = [&](float factor, float gap_ratio) {
    refined.refiner.restart(EdgelIndex(glide_recording().world.camera(), 0));
    std::size_t count = 0;
    for (const FittedEdgel& fitted : edges) {
      Edgel edge = fitted.edge;
      edge.inverse_depth *= factor;
      const NeighbourPrediction prediction{
          0.005F * edge.inverse_depth, gap_ratio * edge.inverse_depth, 0.05F * edge.inverse_depth};
      if (refined.refiner.confirm(edge, prediction, refined.events)) ++count;
    }
    return static_cast<double>(count) / static_cast<double>(edges.size());
  };
  constexpr float kNone = std::numeric_limits<float>::infinity();
  EXPECT_GT(confirmed(1, kNone), 0.45);  // others are too blurred for the residual allowed here
  EXPECT_LT(confirmed(1.3F, kNone), 0.1);
  // Another surface so near that the edgel's own events cannot tell them apart.
  EXPECT_LT(confirmed(1, 1e-5F), 0.05);
}

}  // namespace
}  // namespace saccade
