#include "simulator/sensor/rays/ray_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

// Of the rays that come over the diagonal of a rectangle's two triangles: as the search between both
// ends finds it, from guesses that are off by a hundredth; next to an end of the time it may give up.
TEST(RayTracer, FindsTheChangeOfAViewNearAGuess) {
  testing::ClosedFormPlane plane = testing::ClosedFormPlane::smooth(48, 36);
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  const double to_s = 0.5 * plane.duration_s;
  const SplineTable poses(motion, 0, plane.duration_s);
  EventStatistics statistics;
  RayTracer tracer(scene, statistics);
  tracer.set_poses(poses);
  int changes = 0;
  int found = 0;
  for (int y = 0; y < plane.camera.height; ++y)
    for (int x = 0; x < plane.camera.width; ++x) {
      const Eigen::Vector3d ray = plane.camera.ray(Eigen::Vector2d(x, y));
      TriangleId from = kNothing;
      TriangleId to = kNothing;
      tracer.find_triangles({&ray, 1}, 0, {&from, 1});
      tracer.find_triangles({&ray, 1}, to_s, {&to, 1});
      if (from == to || from == kNothing || to == kNothing) continue;
      const double exact_s = tracer.change_s(ray, {from, 0}, {to, to_s}, 1e-12);
      if (std::isnan(exact_s)) continue;
      ++changes;
      for (const double off : {-0.01, 0.0, 0.01}) {
        const double change_s =
            tracer.change_near_s(ray, from, {0, to_s}, exact_s / to_s + off, 1e-7);
        if (std::isnan(change_s)) continue;
        ++found;
        EXPECT_NEAR(change_s, exact_s, 1e-7) << x << ", " << y << " " << off;
      }
    }
  EXPECT_GT(changes, 10);
  EXPECT_GT(found, 2.9 * changes);
}

}  // namespace
}  // namespace saccade
