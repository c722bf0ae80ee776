#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "simulator/sensor/rays/ray_tracer.h"
#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// The paths of a tile's rays over a triangle's plane.
struct PlaneTrajectories {
  TriangleId triangle;
  SurfaceSample surface;  ///< anywhere on it
  PlanePaths paths;
};

/// Those over the triangles that a tile has asked for last, for a stretch of time.
class TileTrajectories {
 public:
  /// All outlive it.
  TileTrajectories(const RayTracer& tracer, const DirectionLanes& lanes, double from, double to)
      : from_s(from), to_s(to), tracer_(tracer), lanes_(lanes) {}

  const double from_s, to_s;

  /// Of a triangle that is static. Valid until the call after the next.
  const PlaneTrajectories& over(TriangleId triangle) {
    for (std::size_t k = 0; k < std::min(count_, trajectories_.size()); ++k)
      if (trajectories_[k].triangle == triangle) return trajectories_[k];
    PlaneTrajectories& trajectories = trajectories_[count_++ % trajectories_.size()];
    trajectories.triangle = triangle;
    const PlaneSampler from = tracer_.plane_sampler(triangle, from_s);
    from.at(lanes_, trajectories.paths.from);
    tracer_.plane_sampler(triangle, 0.5 * (from_s + to_s)).at(lanes_, trajectories.paths.middle);
    tracer_.plane_sampler(triangle, to_s).at(lanes_, trajectories.paths.to);
    trajectories.paths.from_s = from_s;
    trajectories.paths.length_s = to_s - from_s;
    trajectories.surface = from.surface();
    return trajectories;
  }

 private:
  const RayTracer& tracer_;
  const DirectionLanes& lanes_;
  std::array<PlaneTrajectories, 4> trajectories_;
  std::size_t count_ = 0;
};

}  // namespace saccade
