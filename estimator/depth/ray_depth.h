#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/edge_refiner.h"
#include "estimator/depth/edge_seeds.h"
#include "estimator/depth/event_ownership.h"
#include "estimator/depth/event_rays.h"
#include "estimator/depth/local_planes.h"
#include "estimator/depth/planar_fusion.h"

namespace saccade {

struct PropagationOptions {
  int rounds = 1;
  PlaneOptions plane{.radius_px = 10};
  double spacing_px = 1;   ///< between edges at the same depth
  int min_neighbours = 4;  ///< least sum of weights of a plane
  double min_gap = 4;  ///< to the nearest other surface, in deviations from the edge's own events
  double max_residual_px = 0.4;
  double tolerance = 0.15;       ///< between a seed's depth and the plane's, relative
  double own_strength = 1.6;     ///< seeds weaker than that, over the least, and
  double own_share = 1;          ///< seeds with less of the best plane's votes have only this way
  double own_parallax_px = 1.2;  ///< and those with less parallax across them
  double max_sigma = 0.05;
};

struct RayDepthOptions {
  int slabs = 24;  ///< parts of the window's time in which events are looked up by place
  SeedOptions seeds;
  RefinerOptions refiner;
  OwnershipOptions ownership;
  /// That an edge may move without an event around the time of the view: one that moves farther was
  /// hidden then. It still owns its events.
  double max_unseen_px = 2;
  PropagationOptions propagation;
  FusionOptions fusion;
};

/// The edges that a window shows, before their depths are fused.
struct RayEdges {
  std::vector<FittedEdge> edges;  ///< `first` and `last` count in `events`
  EdgeEvents events;              ///< indices into the window's events
  std::vector<Eigen::Vector2f> seeds;
  std::vector<std::pair<std::string, double>> stages_s;
};

/// Seeds by horizontal strips of the view, which are worked on side by side.
using SeedStrips = std::vector<std::vector<EdgeSeed>>;

/// Depth of edges from the rays of all events at once. No reference image: seeds come from a space
/// sweep, and each seed's inverse depth from a regression over the rays that pass near it, first
/// those near the reference time, then, as the depth gets better, over the whole window.
class RayDepth : public DepthEstimator {
 public:
  RayDepth(const RayDepthOptions& options, const DepthLimits& limits, const PinholeCamera& camera);

  [[nodiscard]] DepthResult estimate(const ViewWindow& window) const override;

  /// The two halves of estimate(), for those that change the edges in between.
  [[nodiscard]] RayEdges find_edges(const ViewWindow& window) const;
  [[nodiscard]] DepthResult fuse(const RayEdges& edges) const;

 private:
  void fit(const EventRays& rays, const SeedStrips& strips, RayEdges& found) const;
  void propagate(const EventRays& rays, const SeedStrips& strips, RayEdges& found) const;
  [[nodiscard]] std::optional<FittedEdge> confirm(const EdgeSeed& seed, LocalPlanes& planes,
                                                  EdgeRefiner& refiner, EdgeEvents& events) const;
  [[nodiscard]] std::vector<EdgeDepth> points_of(const std::vector<FittedEdge>& edges) const;

  RayDepthOptions options_;
  DepthLimits limits_;
  PinholeCamera camera_;  ///< undistorted
  UndistortionTable undistortion_;
};

}  // namespace saccade
