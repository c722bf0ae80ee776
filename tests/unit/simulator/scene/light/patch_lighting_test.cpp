#include "simulator/scene/light/patch_lighting.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/scene_builder.h"
#include "simulator/sensor/visibility/visibility_predictor.h"

namespace saccade {
namespace {

/// A floor of 2 x 2 m at z = 0 under squares at z = 1, with a light at z = 2 or light from above.
Scene floor_under(const std::vector<Eigen::AlignedBox2d>& squares, LightType type) {
  Mesh mesh;
  mesh.materials.emplace_back();
  const auto add = [&](const Eigen::AlignedBox2d& box, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Eigen::Vector2d &low = box.min(), &high = box.max();
    mesh.vertices.insert(mesh.vertices.end(), {{low.x(), low.y(), z},
                                               {high.x(), low.y(), z},
                                               {high.x(), high.y(), z},
                                               {low.x(), high.y(), z}});
    mesh.triangles.push_back({{first, first + 1, first + 2}, 0});
    mesh.triangles.push_back({{first, first + 2, first + 3}, 0});
  };
  add({Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)}, 0);
  for (const auto& square : squares) add(square, 1);
  SceneBuilder builder;
  builder.add(mesh, Eigen::Affine3d::Identity());
  LightOptions light;
  light.type = type;
  light.position = {0, 0, 2};
  builder.light(0.1, {light});
  return std::move(builder).build(Background(0.5));
}

/// From (0, 0, 0.5) onto the floor around `at`.
Frustum sight_of(const Eigen::Vector2d& at) {
  Frustum pyramid{{0, 0, 0.5}, {}, 0};
  const std::array<Eigen::Vector2d, 4> corners{
      {{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}}};
  for (std::size_t k = 0; k < corners.size(); ++k) pyramid.corners[k] << at + corners[k], -0.5;
  return pyramid;
}

class PatchLightOf : public ::testing::TestWithParam<LightType> {
 protected:
  /// The edge of the square's shadow, which begins at x = 0.2 on the height of the square.
  [[nodiscard]] double edge() const { return GetParam() == LightType::kPoint ? 0.4 : 0.2; }
};

TEST_P(PatchLightOf, TellsShadowsExactly) {
  const Scene scene =
      floor_under({{Eigen::Vector2d(0.2, -0.2), Eigen::Vector2d(0.9, 0.2)}}, GetParam());
  const Frustum sight = sight_of({edge(), -0.05});
  PatchLighting buffer;
  const PatchLighting* light = scene.find_lighting(0, {&sight, 1}, 100, buffer);
  ASSERT_NE(light, nullptr);
  EXPECT_EQ(light->unoccluded, 0U);
  EXPECT_EQ(light->lights_at({edge() - 1e-4, -0.05, 0}), 1U);
  EXPECT_EQ(light->lights_at({edge() + 1e-4, -0.05, 0}), 0U);
}

TEST_P(PatchLightOf, AWayBetweenTwoPointsIsJudgedInDoublePrecision) {
  const Scene scene =
      floor_under({{Eigen::Vector2d(0.2, -0.2), Eigen::Vector2d(0.9, 0.2)}}, GetParam());
  const Eigen::Vector3d eye(0, 0, 0.5);
  const Eigen::Vector3d from(edge() - 2e-5, -0.05, 0);
  const Eigen::Vector3d to(edge() + 2e-5, -0.05, 0);
  PatchLighting way;
  ASSERT_TRUE(scene.find_lighting_between(from, to, eye, 0, 1, way));
  const auto lights_at = [&](double x) { return way.lights_at({x, -0.05, 0}); };
  // The shadow is that of points just above the floor, some 1e-6 m nearer to its edge.
  EXPECT_EQ(lights_at(edge() - 1e-5), 1U);
  EXPECT_EQ(lights_at(edge() + 1e-5), 0U);
  double lit = edge() - 1e-5, dark = edge() + 1e-5;
  for (int k = 0; k < 20; ++k)
    (lights_at(0.5 * (lit + dark)) == 1U ? lit : dark) = 0.5 * (lit + dark);
  const Frustum sight = sight_of({edge(), -0.05});
  PatchLighting buffer;
  const PatchLighting* light = scene.find_lighting(0, {&sight, 1}, 100, buffer);
  ASSERT_NE(light, nullptr);
  EXPECT_EQ(light->lights_at({lit - 1e-10, -0.05, 0}), 1U) << "as the exact sampler sees it";
  EXPECT_EQ(light->lights_at({dark + 1e-10, -0.05, 0}), 0U);
  ASSERT_TRUE(scene.find_lighting_between(from, from, eye, 0, 1, way)) << "a way of no length";
  EXPECT_EQ(way.lights_at(from), 1U);
  ASSERT_TRUE(scene.find_lighting_between(from, to, eye, 0, 0, way));
  EXPECT_EQ(way.lights_at(from), 0U) << "none is asked for";
}

TEST_P(PatchLightOf, LeavesNoLightBetweenNeighbours) {
  const Scene scene =
      floor_under({{Eigen::Vector2d(0.2, -0.2), Eigen::Vector2d(0.6, 0.2)}}, GetParam());
  const double x = 2 * edge();  // on the shadow's diagonal
  const double y = 0;
  const Frustum sight = sight_of({x, y});
  PatchLighting buffer;
  const PatchLighting* light = scene.find_lighting(0, {&sight, 1}, 100, buffer);
  ASSERT_NE(light, nullptr);
  for (int k = -50; k <= 50; ++k) {
    const double shift = 1e-4 * k;
    EXPECT_EQ(light->lights_at({x + shift, y + shift, 0}), 0U);
  }
}

TEST_P(PatchLightOf, ProvesWhatNothingCanHide) {
  const Scene scene =
      floor_under({{Eigen::Vector2d(-0.6, -0.6), Eigen::Vector2d(-0.5, -0.5)}}, GetParam());
  const Frustum sight = sight_of({0.7, 0.2});
  PatchLighting buffer;
  const PatchLighting* light = scene.find_lighting(0, {&sight, 1}, 100, buffer);
  ASSERT_NE(light, nullptr);
  EXPECT_EQ(light->lights_at({0.7, 0.2, 0}), 1U);
}

TEST(PatchLighting, FindsSmallThingsUnderTheSunOfALargeScene) {
  // Cards of 4 mm upon a ground of 1.4 km, in light that grazes the ground.
  Mesh mesh;
  mesh.materials.emplace_back();
  mesh.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}};
  mesh.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  for (int k = -40; k <= 40; ++k) {  // so many that they are searched for patch by patch
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const double y = 0.01 * k;
    mesh.vertices.insert(mesh.vertices.end(), {{0, y - 0.002, 0.020},
                                               {0, y + 0.002, 0.020},
                                               {0, y + 0.002, 0.024},
                                               {0, y - 0.002, 0.024}});
    mesh.triangles.push_back({{first, first + 1, first + 2}, 0});
    mesh.triangles.push_back({{first, first + 2, first + 3}, 0});
  }
  SceneBuilder builder;
  builder.add(mesh, Eigen::Affine3d::Identity());
  LightOptions sun;
  sun.type = LightType::kDirectional;
  sun.direction = Eigen::Vector3d(1, 0.05, -0.15).normalized();
  builder.light(0.1, {sun});
  const Scene scene = std::move(builder).build(Background(0.5));
  // Paths to the sun begin a millionth of the scene above the ground.
  const double lift = 1e-3;
  for (const double height : {0.0205, 0.022, 0.0235}) {
    const double way = height - lift;
    const Eigen::Vector2d shadow(way / 0.15, way / 0.15 * 0.05);
    for (int k = 0; k < 200; ++k) {
      const double half = 0.004 + 0.0005 * k;
      const double turn = 0.1 * k;  // of the patch around the shadow
      const Eigen::Vector2d across(half * std::cos(turn), half * std::sin(turn));
      const Eigen::Vector2d along(-across.y(), across.x());
      Frustum sight{{shadow.x() + 0.3, shadow.y() - 0.2, 0.5}, {}, 0};
      const std::array<Eigen::Vector2d, 4> corners{
          {-across - along, across - along, across + along, along - across}};
      for (std::size_t m = 0; m < corners.size(); ++m)
        sight.corners[m] << corners[m] + Eigen::Vector2d(-0.3, 0.2), -0.5;
      PatchLighting buffer;
      const TriangleId ground = shadow.y() < shadow.x() ? 0 : 1;
      const PatchLighting* light = scene.find_lighting(ground, {&sight, 1}, 100, buffer);
      ASSERT_NE(light, nullptr);
      EXPECT_EQ(light->lights_at({shadow.x(), shadow.y(), 0}), 0U) << half;
    }
    const TriangleId ground = shadow.y() < shadow.x() ? 0 : 1;
    const Eigen::Vector3d in_shadow(shadow.x(), shadow.y(), 0);
    const Eigen::Vector3d beside = in_shadow + Eigen::Vector3d(0, 0.005, 0);
    PatchLighting between;
    ASSERT_TRUE(scene.find_lighting_between(in_shadow, beside, {shadow.x(), shadow.y(), 0.5},
                                            ground, 1, between));
    EXPECT_EQ(between.lights_at(in_shadow), 0U) << height;
    EXPECT_EQ(between.lights_at(beside), 1U) << height;
  }
}

INSTANTIATE_TEST_SUITE_P(All, PatchLightOf,
                         ::testing::Values(LightType::kPoint, LightType::kDirectional));

TEST(ShadowTransits, FindsAStripNarrowerThanTheWay) {
  const Scene scene =
      floor_under({{Eigen::Vector2d(0.2, -0.2), Eigen::Vector2d(0.202, 0.2)}}, LightType::kPoint);
  const Frustum sight = sight_of({0.4, 0.05});
  PatchLighting buffer;
  const PatchLighting* light = scene.find_lighting(0, {&sight, 1}, 100, buffer);
  ASSERT_NE(light, nullptr);
  ASSERT_EQ(light->partly_occluded.size(), 1U);
  std::array<Eigen::Vector3d, 3> points;
  for (std::size_t m = 0; m < points.size(); ++m)
    points[m] =
        Eigen::Vector3d(0.395 + 0.005 * static_cast<double>(m), 0.05, 0) + light->shadow_offset;
  std::vector<double> changes;
  ShadowTransits().find(light->partly_occluded[0], points, [&](double begin, double end) {
    changes.push_back(begin);
    changes.push_back(end);
  });
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_NEAR(changes[0], 0.5, 1e-3);
  EXPECT_NEAR(changes[1], 0.9, 1e-3);
}

}  // namespace
}  // namespace saccade
