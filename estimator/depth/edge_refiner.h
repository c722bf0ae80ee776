#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/edge_seeds.h"
#include "estimator/depth/event_ownership.h"
#include "estimator/depth/event_rays.h"
#include "estimator/depth/found_edges.h"
#include "estimator/depth/ray_gather.h"
#include "estimator/depth/ray_regression.h"

namespace saccade {

struct RefinerOptions {
  RegressionOptions regression;
  double spacing_px = 1.4;       ///< between edges at the same depth, at least
  double max_residual_px = 0.5;  ///< deviation of an edge's events from it
  double max_sigma = 0.015;      ///< of the inverse depth, relative; edges with more are dropped
};

/// What the edges around a place say of its inverse depth.
struct Expectation {
  float sigma = 0;    ///< [1/m]
  float gap = 0;      ///< to the nearest other surface around [1/m]
  float min_gap = 4;  ///< least gap, in deviations of the depth from the edge's own events
  float max_residual_px = 0.4F;
  float max_sigma = 0;  ///< stated for an edge whose own events say less [1/m]
};

/// Turns seeds into edges by regressions over more and more of the window, one seed after the
/// other: where an edge was found, later seeds of the same edge are skipped.
class EdgeRefiner {
 public:
  /// Edges at one place whose inverse depths differ by less, relatively, are one.
  static constexpr float kSameDepth = 0.01F;

  /// `rays` and `options` outlive it.
  EdgeRefiner(const EventRays& rays, const RefinerOptions& options, const DepthLimits& limits,
              const PinholeCamera& camera);

  /// From the part of the window that voted for the seed to the whole, each time as far as the
  /// depth found so far reaches. Appends the edge's events to `events`; nullopt where none is.
  [[nodiscard]] std::optional<FittedEdge> refine(const EdgeSeed& seed, EdgeEvents& events);

  /// An edge whose depth is expected at edge.inverse_depth, by what is around it; over the whole
  /// window. Its own events must not contradict, and must tell it from other surfaces nearby.
  [[nodiscard]] std::optional<FittedEdge> confirm(const RayEdge& edge, const Expectation& expected,
                                                  EdgeEvents& events);

  /// Whether there is an edge already, its inverse depth nearer than `tolerance`.
  [[nodiscard]] bool has_found(const RayEdge& edge, float tolerance) const {
    return found_.holds(edge, tolerance);
  }
  /// From now on these, and no others, are what was found.
  void restart(FoundEdges found) { found_ = std::move(found); }

 private:
  [[nodiscard]] bool is_plausible(const RayEdge& edge, const Eigen::Vector2f& start) const;
  [[nodiscard]] FittedEdge accepted(const RayEdge& edge, const RegressionResult& result,
                                    EdgeEvents& events);
  [[nodiscard]] float unseen_px(const EdgeEvents& events, std::size_t first);

  const EventRays& rays_;
  const RefinerOptions& options_;
  DepthLimits limits_;
  PinholeCamera camera_;
  RayGatherer gatherer_;
  FoundEdges found_;
  RayNeighbourhood near_;
  std::vector<float> seen_;  ///< weight of an edge's events in each slab
};

}  // namespace saccade
