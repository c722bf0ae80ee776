#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "simulator/sensor/signal/texel_trajectory.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// The paths of a tile's rays over a triangle's plane.
struct TriangleCourse {
  TriangleId triangle;
  SurfaceLook surface;  ///< anywhere on it
  PlanePaths paths;
};

/// Those over the triangles that a tile has asked for last, for a stretch of time.
class TilePaths {
 public:
  /// All outlive it.
  TilePaths(const RayTracer& tracer, const DirectionLanes& lanes, double from, double to)
      : from_s(from), to_s(to), tracer_(tracer), lanes_(lanes) {}

  const double from_s, to_s;

  /// Of a triangle that stands still. Valid until the call after the next.
  const TriangleCourse& over(TriangleId triangle) {
    for (std::size_t k = 0; k < std::min(count_, courses_.size()); ++k)
      if (courses_[k].triangle == triangle) return courses_[k];
    TriangleCourse& course = courses_[count_++ % courses_.size()];
    course.triangle = triangle;
    const PlaneView from = tracer_.plane_view(triangle, from_s);
    from.at(lanes_, course.paths.from);
    tracer_.plane_view(triangle, 0.5 * (from_s + to_s)).at(lanes_, course.paths.middle);
    tracer_.plane_view(triangle, to_s).at(lanes_, course.paths.to);
    course.paths.from_s = from_s;
    course.paths.length_s = to_s - from_s;
    course.surface = from.surface();
    return course;
  }

 private:
  const RayTracer& tracer_;
  const DirectionLanes& lanes_;
  std::array<TriangleCourse, 4> courses_;
  std::size_t count_ = 0;
};

}  // namespace saccade
