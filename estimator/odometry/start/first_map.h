#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "estimator/odometry/mapper.h"
#include "estimator/odometry/start/path_refinement.h"
#include "estimator/tracking/gyroscope.h"

namespace saccade {

struct FirstMapOptions {
  /// With fewer, depths are assumed; with fewer of these, too, given poses are extrapolated; 0: never.
  std::size_t min_edges = 0;
  double window_s = 0.3;  ///< of the path with the given poses, to a millisecond; at most
  PathRefinementOptions refinement = given_refinement();

 private:
  /// An edge's depth is uncertain, or the poses would not be extrapolated; its events while the poses
  /// are given determine it.
  [[nodiscard]] static PathRefinementOptions given_refinement() {
    PathRefinementOptions options = start_refinement();
    options.min_edges = 60;
    options.rays.refiner.max_sigma = 0.09;
    return options;
  }
};

/// The first keyframe and the path that it was made with.
struct FirstMap {
  PathEstimate path;
  Mapping mapping;

  /// Whether hardly any depth was found, so that the scale of the path from here on is a guess.
  [[nodiscard]] bool is_scale_guessed() const {
    return mapping.keyframe.depth.points.size() < Mapper::kMinEdges;
  }
};

/// What a run starts from. Where the camera hardly translates sideways while its poses are given,
/// few edges have a depth, and tracking would be lost soon after. The others are then mapped at the
/// depth that all edges have in common (Mapper::common_depth()). Where even these are too few, the
/// path is extrapolated at its last velocity and acceleration and adjusted together with the edges
/// (PathRefinement), with the given poses restored each time, until `mapper` makes a map of edges
/// enough, or the path is as long as it may get, or has turned by a quarter of the view; the largest
/// map is taken. Where none has edges that could be tracked, as in a rotation, edges
/// are mapped at an assumed depth: the scale of what follows is a guess. `start` as of Odometry::run(): one without given poses is taken
/// as it is. `events` in order of time; `camera` with its lens; `gyroscope`, where it is not empty,
/// measures the rotation beyond the given poses. Deterministic.
[[nodiscard]] FirstMap first_map(std::span<const Event> events, const PathEstimate& start,
                                 const Mapper& mapper, const PinholeCamera& camera,
                                 const FirstMapOptions& options, const Gyroscope& gyroscope);

}  // namespace saccade
