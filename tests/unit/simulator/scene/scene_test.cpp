#include "simulator/scene/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "simulator/scene/scene_builder.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::look;
using testing::see;

/// The square [-1, 1]^2 at z = 0 with u, v in [0, 1].
Mesh square(double albedo = 0.5) {
  Mesh mesh;
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  mesh.materials = {Material{albedo, nullptr, 1, nullptr}};
  return mesh;
}

/// A unit sphere of latitude and longitude, fine enough to lie within `steps`^-2 of the true one.
Mesh sphere(int steps) {
  Mesh mesh;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= 2 * steps; ++j) {
      const double polar = std::numbers::pi * i / steps;
      const double azimuth = std::numbers::pi * (j % (2 * steps)) / steps;
      mesh.vertices.emplace_back(std::sin(polar) * std::cos(azimuth),
                                 std::sin(polar) * std::sin(azimuth), std::cos(polar));
    }
  const auto row = static_cast<std::uint32_t>(2 * steps + 1);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(steps); ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t k = i * row + j;
      mesh.triangles.push_back({{k, k + row, k + 1}, 0});
      mesh.triangles.push_back({{k + 1, k + row, k + row + 1}, 0});
    }
  mesh.materials = {Material{}};
  return mesh;
}

Eigen::Affine3d at(double x, double y, double z) {
  return Eigen::Affine3d(Eigen::Translation3d(x, y, z));
}

Scene single(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh, double background = 0.7) {
  SceneBuilder builder;
  builder.add(mesh, world_from_mesh);
  return std::move(builder).build(Background(background));
}

TEST(Scene, DistanceToAPlaneIsExactInDouble) {
  const Scene scene = single(square(), at(0.3, 0.2, 2.5));
  const Random random(1);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction(0.5 * random.uniform(0, i) - 0.25,
                                    0.5 * random.uniform(1, i) - 0.25, 1);
    const Shade shade = see(scene, {{0.1, 0.1, -0.7}, direction});
    EXPECT_NEAR(shade.distance, 3.2, 1e-14);
    EXPECT_DOUBLE_EQ(shade.radiance, 0.5);
  }
}

TEST(Scene, DistanceToASphereIsThatOfTheSphere) {
  const Scene scene = single(sphere(200), at(0, 0, 4));
  for (double x = -0.8; x <= 0.8; x += 0.1) {
    const Shade shade = see(scene, {{x, 0.1, 0}, Eigen::Vector3d::UnitZ()});
    EXPECT_NEAR(shade.distance, 4 - std::sqrt(1 - x * x - 0.01), 1e-3) << x;
  }
}

TEST(Scene, NoRaySlipsBetweenTrianglesOfAClosedSurface) {
  const Scene scene = single(sphere(40), at(0, 0, 0));
  const Random random(2);
  std::array<Ray, 16> rays;
  std::array<TriangleId, 16> triangles;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    for (std::uint64_t k = 0; k < 16; ++k)
      rays[k] = {{0.1, -0.2, 0.05},
                 {random.normal(0, 16 * i + k), random.normal(1, 16 * i + k),
                  random.normal(2, 16 * i + k)}};
    scene.visible(rays, triangles);
    for (std::size_t k = 0; k < 16; ++k) {
      ASSERT_NE(triangles[k], kNothing);
      EXPECT_GT(scene.shade(rays[k], triangles[k]).distance, 0);
    }
  }
}

TEST(Scene, PacketsOfAnySizeAgreeWithSingleRays) {
  const Scene scene = single(sphere(20), at(0, 0, 3));
  for (std::size_t count = 0; count <= 16; ++count) {
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < count; ++k)
      rays.push_back({{0.17 * static_cast<double>(k) - 1.3, 0.03, 0}, Eigen::Vector3d::UnitZ()});
    std::vector<TriangleId> triangles(count);
    scene.visible(rays, triangles);
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(triangles[k], look(scene, rays[k]));
  }
}

TEST(Scene, MeetsAgreesWithVisibleAndIncludesEdges) {
  const Scene scene = single(square(), at(0, 0, 1));
  const Ray diagonal{{0.25, 0.25, 0}, Eigen::Vector3d::UnitZ()};
  EXPECT_TRUE(scene.intersects(diagonal, 0));
  EXPECT_TRUE(scene.intersects(diagonal, 1));
  const Ray inside{{0.5, -0.5, 0}, Eigen::Vector3d::UnitZ()};
  EXPECT_TRUE(scene.intersects(inside, look(scene, inside)));
  EXPECT_NE(scene.intersects(inside, 0), scene.intersects(inside, 1));
  EXPECT_FALSE(scene.intersects({{0.5, -0.5, 2}, Eigen::Vector3d::UnitZ()}, 0)) << "behind the ray";
  EXPECT_FALSE(scene.intersects(inside, kNothing));
}

TEST(Scene, BackgroundIsWhereNothingIs) {
  const Scene scene = single(square(), at(0, 0, 1), 0.7);
  const Ray away{{0, 0, 0}, -Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(look(scene, away), kNothing);
  EXPECT_DOUBLE_EQ(see(scene, away).radiance, 0.7);
  EXPECT_EQ(see(scene, away).distance, 0);
}

TEST(Scene, EnvironmentMapIsSeenFromInside) {
  ImageF map(4, 2);
  for (int i = 0; i < 8; ++i) map.data()[i] = static_cast<float>(i);
  const Background background(map);
  const double east = background.sample({1, -1, 0}).radiance();  // right of the middle column
  EXPECT_NEAR(east, 0.5 * (2 + 6), 1e-12);
  EXPECT_NEAR(background.sample({2, 2, 0}).radiance(), 0.5 * (1 + 5), 1e-12);
  EXPECT_NEAR(background.sample({-1, 1, 0}).radiance(), 0.5 * (0 + 4), 1e-12);
  EXPECT_NEAR(background.sample({1e-9, -1e-9, 1}).radiance(), 2, 1e-6) << "the top row is +z";
}

TEST(Scene, ObjectsAreNumberedInTheirOrder) {
  SceneBuilder builder;
  builder.add(square(), at(0, 0, 2));
  builder.add(square(), at(5, 0, 1));
  const Scene scene = std::move(builder).build(Background(0));
  EXPECT_EQ(scene.triangle_count(), 4U);
  EXPECT_EQ(scene.object(look(scene, {{5.1, 0, 0}, Eigen::Vector3d::UnitZ()})), 1U);
  EXPECT_EQ(scene.object(look(scene, {{0.1, 0, 0}, Eigen::Vector3d::UnitZ()})), 0U);
}

TEST(Scene, TextureLiesOnTheSurfaceByItsCoordinates) {
  ImageF image(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) image(x, y) = static_cast<float>(x + 100 * y);
  Mesh mesh = square();
  mesh.materials[0].texture = std::make_shared<Texture>(image);
  const Scene scene = single(mesh, at(0, 0, 1));
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      const double u = (x + 0.5) / 8;
      const double v = 1 - (y + 0.5) / 4;
      const Ray ray{{2 * u - 1, 2 * v - 1, 0}, Eigen::Vector3d::UnitZ()};
      EXPECT_NEAR(see(scene, ray).radiance, x + 100 * y, 1e-9);
    }
}

TEST(Scene, ShiftedTextureCoordinatesShowTheSame) {
  ImageF image(8, 4);
  for (int i = 0; i < 32; ++i) image.data()[i] = static_cast<float>((i * 7) % 11);
  Mesh plain = square();
  plain.materials[0].texture = std::make_shared<Texture>(image);
  Mesh shifted = plain;
  for (Eigen::Vector2d& uv : shifted.uvs) uv += Eigen::Vector2d(3, -5);
  const Scene a = single(plain, at(0, 0, 1));
  const Scene b = single(shifted, at(0, 0, 1));
  for (double x = -0.99; x < 1; x += 0.07) {
    const Ray ray{{x, 0.6 * x, 0}, Eigen::Vector3d::UnitZ()};
    EXPECT_NEAR(see(a, ray).radiance, see(b, ray).radiance, 1e-9);
  }
}

TEST(Scene, ColoursOfVerticesAreInterpolated) {
  Mesh mesh = square();
  mesh.colours = {0.1, 0.5, 0.9, 0.5};
  const Scene scene = single(mesh, at(0, 0, 1));
  EXPECT_NEAR(see(scene, {{0.5, 0, 0}, Eigen::Vector3d::UnitZ()}).radiance, 0.6, 1e-12);
}

TEST(Scene, CutoutsLetRaysThrough) {
  SceneBuilder builder;
  builder.add(square(0.9), at(0, 0, 3));
  Mesh screen = square(0.1);
  ImageF holes(2, 2, 1.0F);
  holes(0, 0) = 0;  // x < 0, y > 0
  screen.materials[0].opacity = std::make_shared<Texture>(holes, Wrap::kClamp, Wrap::kClamp);
  builder.add(screen, at(0, 0, 1));
  const Scene scene = std::move(builder).build(Background(0));
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  const Ray through{{-0.6, 0.6, 0}, forward};
  const Ray onto{{0.6, 0.6, 0}, forward};
  EXPECT_NEAR(see(scene, through).distance, 3, 1e-12);
  EXPECT_NEAR(see(scene, onto).distance, 1, 1e-12);
  const std::array<Ray, 2> both{through, onto};
  std::array<TriangleId, 2> triangles;
  scene.visible(both, triangles);
  EXPECT_EQ(scene.object(triangles[0]), 0U);
  EXPECT_EQ(scene.object(triangles[1]), 1U);
  EXPECT_FALSE(scene.intersects(through, triangles[1]));
}

TEST(Scene, TrianglesWithoutAreaAreLeftOut) {
  Mesh mesh = square();
  mesh.triangles.push_back({{0, 1, 1}, 0});
  mesh.triangles.push_back({{2, 2, 2}, 0});
  SceneBuilder builder;
  EXPECT_EQ(builder.add(mesh, at(0, 0, 0)), 2U);
}

LightOptions lamp(const Eigen::Vector3d& position, double intensity, bool shadows = true) {
  LightOptions light;
  light.position = position;
  light.intensity = intensity;
  light.shadows = shadows;
  return light;
}

TEST(SceneLight, FollowsCosineAndDistance) {
  SceneBuilder builder;
  builder.add(square(0.5), at(0, 0, 0));
  LightOptions sun;
  sun.type = LightType::kDirectional;
  sun.direction = {0, 3, -4};
  sun.intensity = 2;
  builder.light(0.25, {lamp({0.5, 0, 2}, 3), sun});
  const Scene scene = std::move(builder).build(Background(0));
  const double expected = 0.5 * (0.25 + 3 * (2 / std::sqrt(4.25)) / 4.25 + 2 * 0.8);
  const Ray from_above{{0, 0, 5}, -Eigen::Vector3d::UnitZ()};
  const Ray slanted{{1, 2, 5}, {-1, -2, -5}};
  EXPECT_NEAR(see(scene, from_above).radiance, expected, 1e-9);
  EXPECT_NEAR(see(scene, slanted).radiance, expected, 1e-9) << "the same from everywhere";
  const Ray from_below{{0, 0, -5}, Eigen::Vector3d::UnitZ()};
  EXPECT_NEAR(see(scene, from_below).radiance, 0.5 * 0.25, 1e-12) << "the dark side";
}

TEST(SceneLight, ShadowsEndWhereTheirBlockerDoes) {
  for (const bool shadows : {true, false}) {
    SceneBuilder builder;
    builder.add(square(1), at(0, 0, 0));
    Eigen::Affine3d small = at(0, 0, 1);
    small.scale(0.1);
    builder.add(square(1), small);
    builder.light(0.1, {lamp({0, 0, 2}, 4, shadows)});
    const Scene scene = std::move(builder).build(Background(0));
    // The blocker's border at 0.1 throws its shadow's to 0.2.
    const double inside = see(scene, {{0.199, 0.15, 0.5}, -Eigen::Vector3d::UnitZ()}).radiance;
    const double outside = see(scene, {{0.201, 0.15, 0.5}, -Eigen::Vector3d::UnitZ()}).radiance;
    EXPECT_EQ(inside < 0.11, shadows);
    EXPECT_GT(outside, 0.9);
  }
}

TEST(SceneLight, NoSurfaceShadesItself) {
  SceneBuilder builder;
  builder.add(sphere(60), at(7, -3, 2));
  builder.light(0, {lamp({7, -3, 6}, 16)});
  const Scene scene = std::move(builder).build(Background(0));
  for (double x = -0.6; x < 0.61; x += 0.013) {
    const Shade shade = see(scene, {{7 + x, -3 + 0.2 * x, 9}, -Eigen::Vector3d::UnitZ()});
    EXPECT_GT(shade.radiance, 0.1) << x;
  }
}

TEST(SceneLight, SmoothNormalsShadeSmoothly) {
  Mesh round = sphere(12);
  round.normals = round.vertices;
  SceneBuilder builder;
  builder.add(round, at(0, 0, 0));
  builder.light(0, {lamp({0, 0, 1000}, 1e6, false)});
  const Scene scene = std::move(builder).build(Background(0));
  double last = 2;
  for (double x = 0.05; x < 0.9; x += 0.01) {
    const double radiance = see(scene, {{x, 0.02, 5}, -Eigen::Vector3d::UnitZ()}).radiance;
    EXPECT_NEAR(radiance, 0.5 * std::sqrt(1 - x * x), 0.02);
    EXPECT_LT(radiance, last);
    last = radiance;
  }
}

}  // namespace
}  // namespace saccade
