#include "simulator/sensor/visibility/edge_culling.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "simulator/sensor/visibility/triangle_ray_bounds.h"

namespace saccade {
namespace {

constexpr double kMargin = 2.5e-4;

/// One number after another.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return random_.uniform(0, index_++); }

 private:
  Random random_;
  std::uint64_t index_ = 0;
};

Eigen::Vector3d random_point(Draws& random, double size) {
  return {size * (random.uniform() - 0.5), size * (random.uniform() - 0.5),
          1 + 2 * (random.uniform() - 0.3)};
}

/// A triangle that moves past a camera at the origin.
TransitTriangle random_triangle(Draws& random) {
  std::array<Eigen::Vector3d, 3> corners;
  const Eigen::Vector3d centre = random_point(random, 2);
  for (auto& corner : corners) corner = centre + 0.3 * random_point(random, 1);
  const Eigen::Vector3d motion = 0.1 * random_point(random, 1);
  TransitTriangle triangle{0, {}};
  for (std::size_t m = 0; m < 3; ++m) {
    std::array<Eigen::Vector3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = corners[k] + static_cast<double>(m) * motion;
    EdgeFunctions& pass = triangle.at[m];
    for (std::size_t k = 0; k < 3; ++k) pass.edges[k] = at[(k + 1) % 3].cross(at[(k + 2) % 3]);
    pass.w = pass.edges[0] + pass.edges[1] + pass.edges[2];
    pass.depth = at[0].dot(at[1].cross(at[2]));
  }
  return triangle;
}

TEST(EdgeCulling, KeepsAllThatMayBeMetAndLittleElse) {
  Draws random(1);
  std::vector<TransitTriangle> triangles;
  EdgeCulling test;
  test.clear(kMargin);
  for (int i = 0; i < 500; ++i) {
    triangles.push_back(random_triangle(random));
    test.add(triangles.back());
  }
  std::size_t kept = 0;
  std::size_t needed = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction(random.uniform() - 0.5, random.uniform() - 0.5, 1);
    std::set<std::size_t> found;
    test.visit_candidates(direction, [&](std::size_t k) { found.insert(k); });
    kept += found.size();
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      bool may_be_met = false;
      triangles[k].find_transits(direction, [&](double, double) { may_be_met = true; });
      needed += may_be_met ? 1 : 0;
      EXPECT_TRUE(!may_be_met || found.count(k) == 1);
      if (TriangleRayBounds(triangles[k], direction, 2 * kMargin).stays_outside()) {
        EXPECT_EQ(found.count(k), 0U);
      }
    }
  }
  EXPECT_GT(needed, 100U);
  EXPECT_LT(kept, 3 * needed);
}

TEST(EdgeCulling, StartsAfresh) {
  Draws random(2);
  EdgeCulling test;
  test.clear(kMargin);
  for (int i = 0; i < 40; ++i) test.add(random_triangle(random));
  test.clear(kMargin);
  std::size_t found = 0;
  test.visit_candidates({0, 0, 1}, [&](std::size_t) { ++found; });
  EXPECT_EQ(found, 0U);
}

}  // namespace
}  // namespace saccade
