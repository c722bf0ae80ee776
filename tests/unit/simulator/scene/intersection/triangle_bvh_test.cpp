#include "simulator/scene/intersection/triangle_bvh.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

/// Looks along +z from (x, 0, 0) through a square of half the side `half` at z = 1.
Frustum pyramid(double x, double half) {
  return {{x, 0, 0}, {{{-half, -half, 1}, {half, -half, 1}, {half, half, 1}, {-half, half, 1}}}};
}

Mesh wall(double x, double y, double z, double side) {
  return testing::rectangle({x - 0.5 * side, y - 0.5 * side, z}, {side, 0, 0}, {0, side, 0},
                            ImageF(2, 2, 0.5F));
}

const std::vector<Frustum> kStaticBody{pyramid(0, 0.1)};
const std::vector<Frustum> kMoving{pyramid(-0.1, 0.1), pyramid(0, 0.1), pyramid(0.1, 0.1)};

/// The triangle of the first wall, which lies below its diagonal, with the pyramid inside it.
std::vector<Frustum> aside(std::vector<Frustum> sweep) {
  for (Frustum& p : sweep) p.eye += Eigen::Vector3d(1.5, -1.5, 0);
  return sweep;
}

TEST(Alone, ATriangleThatFillsTheView) {
  const Scene scene = testing::scene_of({wall(0, 0, 3, 10)});
  EXPECT_TRUE(scene.is_sole_visible(0, aside(kStaticBody)));
  EXPECT_TRUE(scene.is_sole_visible(0, aside(kMoving)));
  EXPECT_FALSE(scene.is_sole_visible(1, aside(kStaticBody))) << "the other half of the wall";
  EXPECT_FALSE(scene.is_sole_visible(0, kStaticBody)) << "the diagonal crosses the view";
}

TEST(Alone, NotBehindWhatIsInView) {
  const Scene scene = testing::scene_of({wall(0, 0, 3, 10), wall(1.5, -1.5, 1, 0.001)});
  EXPECT_FALSE(scene.is_sole_visible(0, aside(kStaticBody)));
}

TEST(Alone, NotBehindWhatComesIntoView) {
  const Scene scene = testing::scene_of({wall(0, 0, 3, 10), wall(1.5 + 0.15, -1.5, 1, 0.01)});
  EXPECT_TRUE(scene.is_sole_visible(0, aside(kStaticBody)));
  EXPECT_FALSE(scene.is_sole_visible(0, aside(kMoving)));
}

TEST(Alone, WhateverIsBehindOrBesideTheView) {
  const Scene scene = testing::scene_of(
      {wall(0, 0, 3, 10), wall(1.5, -1.5, 5, 1), wall(3.5, -1.5, 1, 1), wall(1.5, -1.5, -2, 10)});
  EXPECT_TRUE(scene.is_sole_visible(0, aside(kMoving)));
}

TEST(Alone, TheBackgroundWhereNothingIs) {
  const Scene scene = testing::scene_of({wall(3, 0, 2, 1)});
  EXPECT_TRUE(scene.is_sole_visible(kNothing, kMoving));
  std::vector<Frustum> towards = kMoving;
  towards.back().eye.x() = 2.5;
  EXPECT_FALSE(scene.is_sole_visible(kNothing, towards));
}

// A proof may never be wrong: wherever it is given, no ray of the moving pyramid intersects another
// triangle.
TEST(Alone, HoldsForRaysAmongManyTriangles) {
  const Random random(4);
  std::vector<Mesh> meshes{wall(0, 0, 6, 40)};
  for (std::uint64_t k = 0; k < 400; ++k)
    meshes.push_back(wall(10 * random.uniform(1, k) - 5, 10 * random.uniform(2, k) - 5,
                          0.5 + 5 * random.uniform(3, k), 0.02 + 0.2 * random.uniform(4, k)));
  const Scene scene = testing::scene_of(meshes);
  int proven = 0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    std::vector<Frustum> sweep{pyramid(0, 0.02), pyramid(0.03, 0.02), pyramid(0.06, 0.02)};
    const Eigen::Vector3d turn(random.uniform(5, k) - 0.2, 0.4 * random.uniform(6, k) - 0.6, 0);
    for (Frustum& p : sweep)
      for (Eigen::Vector3d& corner : p.corners) corner += turn;
    if (!scene.is_sole_visible(0, sweep)) continue;
    ++proven;
    for (std::uint64_t i = 0; i < 200; ++i) {
      const auto draw = [&](std::uint64_t j) { return random.uniform(7 + j, 1000 * k + i); };
      const Ray ray{{0.06 * draw(0), 0, 0},
                    turn + Eigen::Vector3d(0.04 * draw(1) - 0.02, 0.04 * draw(2) - 0.02, 1)};
      TriangleId seen = kNothing;
      scene.visible({&ray, 1}, {&seen, 1});
      ASSERT_EQ(seen, 0U);
    }
  }
  EXPECT_GT(proven, 50);
  EXPECT_LT(proven, 390);
}

}  // namespace
}  // namespace saccade
