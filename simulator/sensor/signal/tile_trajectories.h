#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "simulator/sensor/rays/ray_tracer.h"
#include "simulator/sensor/signal/texel_trajectory.h"

namespace saccade {

/// The trajectories of a tile's rays over the texture of a static triangle, from what they see at
/// both ends of an interval of time and in its middle.
struct PlaneTrajectories {
  TriangleId triangle;
  SurfaceSample surface;  ///< anywhere on it
  TexelLanes from, middle, to;
  double from_s, length_s;

  [[nodiscard]] TexelTrajectory of_pixel(std::size_t i) const {
    const auto coordinate = [&](const Lanes& a, const Lanes& a_rate, const Lanes& b,
                                const Lanes& b_rate, const Lanes& c, const Lanes& c_rate) {
      return TrajectoryCoordinate(a[i], a_rate[i] * length_s, b[i], b_rate[i] * length_s, c[i],
                                  c_rate[i] * length_s);
    };
    return {coordinate(from.x, from.x_rate, middle.x, middle.x_rate, to.x, to.x_rate),
            coordinate(from.y, from.y_rate, middle.y, middle.y_rate, to.y, to.y_rate), from_s,
            length_s};
  }
};

/// Those over the triangles that a tile has asked for last, for an interval of time.
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
    const PlaneSampler sampler = tracer_.plane_sampler(triangle, from_s);
    sampler.at(lanes_, trajectories.from);
    tracer_.plane_sampler(triangle, 0.5 * (from_s + to_s)).at(lanes_, trajectories.middle);
    tracer_.plane_sampler(triangle, to_s).at(lanes_, trajectories.to);
    trajectories.from_s = from_s;
    trajectories.length_s = to_s - from_s;
    trajectories.surface = sampler.surface();
    return trajectories;
  }

 private:
  const RayTracer& tracer_;
  const DirectionLanes& lanes_;
  std::array<PlaneTrajectories, 4> trajectories_;
  std::size_t count_ = 0;
};

}  // namespace saccade
