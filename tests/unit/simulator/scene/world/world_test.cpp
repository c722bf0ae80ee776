#include "simulator/scene/world/world.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/scene/world/world_geometry.h"
#include "simulator/scene/world/world_pictures.h"
#include "simulator/scene/world/world_texture.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

WorldOptions world_of(WorldGeometry geometry, std::uint64_t seed,
                      WorldTexture texture = WorldTexture::kRectangles) {
  return {geometry, texture, seed, std::nullopt};
}

World made(const WorldOptions& options) {
  SceneRemarks remarks;
  return make_world(options, remarks);
}

Scene scene_of(const WorldOptions& options) {
  SceneOptions scene;
  scene.world = options;
  return build_scene(scene);
}

/// Distance of the origin from a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double distance_to(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  const auto is_left = [&](const Vector3d& p, const Vector3d& q) {
    return n.dot((q - p).cross(-p)) >= 0;
  };
  if (is_left(a, b) && is_left(b, c) && is_left(c, a)) return std::abs(n.dot(a)) / n.norm();
  double nearest = a.norm();
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vector3d edge = q - p;
    const double s = std::clamp(-p.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p + s * edge).norm());
  }
  return nearest;
}

double nearest_surface(const World& world) {
  double nearest = 1e9;
  for (const WorldPart& part : world.parts) {
    if (part.trajectory) continue;
    const auto at = [&](std::uint32_t i) -> Vector3d {
      return part.world_from_mesh * part.mesh.vertices[i];
    };
    for (const Triangle& triangle : part.mesh.triangles) {
      const auto& [a, b, c] = triangle.corners;
      nearest = std::min(nearest, distance_to(at(a), at(b), at(c)));
    }
  }
  return nearest;
}

/// The distance along rays (x, 1, z) with |x| and |z| up to tan 50 degrees; 0 where nothing is.
std::vector<double> distances_in_view(const Scene& scene, const Vector3d& from, int side) {
  const double widest = std::tan(50 * std::numbers::pi / 180);
  std::vector<double> distances;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const Vector3d direction(widest * (2.0 * i / (side - 1) - 1), 1,
                               widest * (2.0 * j / (side - 1) - 1));
      const Ray ray{from, direction};
      TriangleId triangle = kNothing;
      scene.visible({&ray, 1}, {&triangle, 1});
      distances.push_back(triangle == kNothing ? 0 : scene.shade(ray, triangle).distance);
    }
  return distances;
}

class EveryGeometry : public ::testing::TestWithParam<WorldGeometryKind> {};

TEST_P(EveryGeometry, LeavesTheBallFree) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const World world = made(world_of(GetParam().geometry, seed));
    EXPECT_GE(nearest_surface(world), kWorldFreeRadius_m) << seed;
    EXPECT_GE(world.parts.size() + world.files.size(), 7) << seed;
  }
}

TEST_P(EveryGeometry, FillsTheViewFromAnywhereInTheBall) {
  const Scene scene = scene_of(world_of(GetParam().geometry, 7));
  WorldDice dice(1, 1);
  for (int pose = 0; pose < 8; ++pose) {
    const Vector3d from = pose == 0 ? Vector3d::Zero() : Vector3d(0.5 * dice.direction());
    const std::vector<double> distances = distances_in_view(scene, from, 61);
    // From within half a metre nothing is nearer than 0.3 m, nor farther along y than the corner of
    // the largest shell.
    EXPECT_GT(std::ranges::min(distances), 0.15) << pose;
    EXPECT_LT(std::ranges::max(distances), 10) << pose;
  }
}

/// Whether both show the same, to the bit.
bool is_same(const World& a, const World& b) {
  if (a.parts.size() != b.parts.size() || a.files.size() != b.files.size()) return false;
  for (std::size_t k = 0; k < a.parts.size(); ++k) {
    const Mesh &x = a.parts[k].mesh, &y = b.parts[k].mesh;
    if (x.vertices != y.vertices || x.uvs != y.uvs ||
        a.parts[k].world_from_mesh.matrix() != b.parts[k].world_from_mesh.matrix())
      return false;
    for (std::size_t m = 0; m < x.materials.size(); ++m)
      if (!std::ranges::equal(x.materials[m].texture->image().pixels(),
                              y.materials[m].texture->image().pixels()))
        return false;
  }
  return std::ranges::equal(a.files, b.files, [](const MeshOptions& x, const MeshOptions& y) {
    return x.file == y.file && x.transform.translation == y.transform.translation &&
           x.transform.rotation_deg == y.transform.rotation_deg;
  });
}

TEST_P(EveryGeometry, DependsOnItsSeedAlone) {
  EXPECT_TRUE(
      is_same(made(world_of(GetParam().geometry, 8)), made(world_of(GetParam().geometry, 8))));
  EXPECT_FALSE(
      is_same(made(world_of(GetParam().geometry, 8)), made(world_of(GetParam().geometry, 9))));
}

TEST_P(EveryGeometry, HasTextureCoordinatesThatNeitherStretchNorCollapse) {
  const World world = made(world_of(GetParam().geometry, 10));
  for (const WorldPart& part : world.parts)
    for (const Triangle& triangle : part.mesh.triangles) {
      const auto& [a, b, c] = triangle.corners;
      const auto& v = part.mesh.vertices;
      const auto& uv = part.mesh.uvs;
      const Texture& texture = *part.mesh.materials[triangle.material].texture;
      const Eigen::Vector2d texels(texture.width(), texture.height());
      const Eigen::Vector2d p = (uv[b] - uv[a]).cwiseProduct(texels);
      const Eigen::Vector2d q = (uv[c] - uv[a]).cwiseProduct(texels);
      const double area_m2 = (v[b] - v[a]).cross(v[c] - v[a]).norm();
      const double per_m = std::sqrt(std::abs(p.x() * q.y() - p.y() * q.x()) / area_m2);
      // 640 texels per metre, enlarged 2.5 times; on what is larger than a texture and on steep
      // reliefs, fewer. On the rim of a sphere's faces an area is 0.7 of what it is in their middle,
      // and the sides of a rod of eight are 2.6 % shorter than its circumference.
      EXPECT_GT(per_m, 100) << part.name;
      EXPECT_LT(per_m, 640 * std::sqrt(1 / 0.7 * 1.026)) << part.name;
    }
}

INSTANTIATE_TEST_SUITE_P(, EveryGeometry,
                         ::testing::ValuesIn(world_geometries().begin(), world_geometries().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

/// The first of some pictures whose package is not installed, as an error says it; "" with all.
std::string first_problem(std::span<const WorldPicture> pictures) {
  for (const WorldPicture& picture : pictures)
    if (const std::string problem = missing_picture_problem(picture); !problem.empty())
      return problem;
  return "";
}

class EveryTexture : public ::testing::TestWithParam<WorldTextureKind> {
 protected:
  void SetUp() override {
    std::string problem;
    if (GetParam().texture == WorldTexture::kPhotographs)
      problem = first_problem(world_photographs());
    if (GetParam().texture == WorldTexture::kDrawings) problem = first_problem(world_drawings());
    if (!problem.empty()) GTEST_SKIP() << problem;
  }

  static std::vector<WorldSheet> sheets(std::uint64_t seed) {
    SceneRemarks remarks;
    WorldTextureRequest request{{seed, 1}, ColourChannel::kLuminance, remarks};
    return GetParam().make(request);
  }
};

TEST_P(EveryTexture, IsAnAlbedoWithDetailThatFitsInMemory) {
  std::size_t texels = 0;
  for (const WorldSheet& sheet : sheets(1)) {
    const auto [low, high] = std::ranges::minmax(sheet.albedo.pixels());
    EXPECT_GT(low, 0);
    EXPECT_LE(high, 1);
    EXPECT_GT(high / low, 1.2);
    texels += sheet.albedo.size();
  }
  // A texel takes 4 bytes, with its pyramids 9: 400 MB.
  EXPECT_LT(texels, 45e6);
}

TEST_P(EveryTexture, IsTheSameForAnyNumberOfThreads) {
  const int threads = thread_count();
  set_thread_count(1);
  const std::vector<WorldSheet> one = sheets(2);
  set_thread_count(3);
  const std::vector<WorldSheet> three = sheets(2), other = sheets(3);
  set_thread_count(threads);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_TRUE(std::ranges::equal(one[k].albedo.pixels(), three[k].albedo.pixels()));
  EXPECT_FALSE(std::ranges::equal(one[0].albedo.pixels(), other[0].albedo.pixels()));
}

INSTANTIATE_TEST_SUITE_P(, EveryTexture,
                         ::testing::ValuesIn(world_textures().begin(), world_textures().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

std::pair<float, float> albedo_range(WorldTexture texture) {
  const World world = made(world_of(WorldGeometry::kLayers, 1, texture));
  std::pair<float, float> range{1, 0};
  for (const Material& material : world.parts.front().mesh.materials) {
    EXPECT_EQ(material.factor, 1);
    const auto [low, high] = std::ranges::minmax(material.texture->image().pixels());
    range = {std::min(range.first, low), std::max(range.second, high)};
  }
  return range;
}

TEST(World, FaintTexturesStayWithinFifteenPercent) {
  const auto [low, high] = albedo_range(WorldTexture::kFaint);
  EXPECT_GE(low, 0.5 * 0.85 - 1e-6);
  EXPECT_LE(high, 0.5 * 1.15 + 1e-6);
}

TEST(World, ContrastTexturesReachTenToOne) {
  const auto [low, high] = albedo_range(WorldTexture::kContrast);
  EXPECT_NEAR(high / low, 10, 0.1);
}

TEST(World, SeedsOfGeometryAndTextureAreApart) {
  WorldOptions options = world_of(WorldGeometry::kClutter, 3);
  const World first = made(options);
  options.texture_seed = 4;
  const World repainted = made(options);
  ASSERT_EQ(first.parts.size(), repainted.parts.size());
  bool is_repainted = false;
  for (std::size_t k = 0; k < first.parts.size(); ++k) {
    EXPECT_EQ(first.parts[k].mesh.vertices, repainted.parts[k].mesh.vertices);
    is_repainted = is_repainted || first.parts[k].mesh.uvs != repainted.parts[k].mesh.uvs;
  }
  EXPECT_TRUE(is_repainted);
  options = world_of(WorldGeometry::kClutter, 3);
  options.texture_seed = 3;
  EXPECT_TRUE(is_same(first, made(options)));
}

TEST(World, OneObjectOfAMovingWorldMovesAndTakesATenthOfTheViewAtMost) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const World world = made(world_of(WorldGeometry::kMoving, seed));
    const auto moves = [](const WorldPart& part) { return part.trajectory.has_value(); };
    ASSERT_EQ(std::ranges::count_if(world.parts, moves), 1) << seed;
    const WorldPart& object = *std::ranges::find_if(world.parts, moves);
    const Spline motion = build_motion(*object.trajectory);
    double radius = 0;
    for (const Vector3d& vertex : object.mesh.vertices) radius = std::max(radius, vertex.norm());
    EXPECT_GT((motion.pose(0.5).translation() - motion.pose(0).translation()).norm(), 0.01);
    for (double t = 0; t < 3; t += 0.02) {
      const Vector3d at = motion.pose(t).translation();
      EXPECT_GT(at.norm() - radius, kWorldFreeRadius_m) << seed;
      // The disc that it covers at most, over the narrowest view that worlds are drawn with, 50
      // degrees wide and of three quarters of this height.
      const double width = 2 * at.y() * std::tan(25 * std::numbers::pi / 180);
      EXPECT_LT(std::numbers::pi * radius * radius / (0.75 * width * width), 0.1) << seed;
    }
  }
}

TEST(World, StandsBesideMeshes) {
  const auto objects = [](const std::string& yaml) {
    const Scene scene = build_scene(config::read<SceneOptions>(config::parse(yaml, "s.yaml", ".")));
    std::set<std::uint32_t> found;
    for (const SceneInstance& instance : scene.instances()) found.insert(instance.object);
    return found.size();
  };
  const std::string world = "world: {geometry: corridor, texture: rectangles, seed: 2}\n";
  const std::string mesh = testing::source_path("scenes/planes/planes.obj");
  EXPECT_EQ(objects(world + "meshes: [{file: " + mesh + "}]\n"), objects(world) + 1);
}

std::string problem_of(const std::string& yaml) {
  try {
    static_cast<void>(config::read<SceneOptions>(config::parse(yaml, "scene.yaml", ".")));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(World, RejectsWhatItDoesNotKnow) {
  EXPECT_THAT(problem_of("world: {geometry: coridor}"),
              AllOf(HasSubstr("scene.yaml:1"), HasSubstr("geometry"), HasSubstr("'corridor'")));
  EXPECT_THAT(problem_of("world: {texture: photos}"),
              AllOf(HasSubstr("texture"), HasSubstr("photographs")));
  EXPECT_THAT(problem_of("world: {seed: -1}"), HasSubstr("seed"));
  EXPECT_THAT(problem_of("world: {sead: 1}"), HasSubstr("seed"));
}

TEST(World, NamesThePackageOfAPictureThatIsMissing) {
  EXPECT_THAT(missing_picture_problem({"/usr/share/none/a.png", "none-data"}),
              AllOf(HasSubstr("/usr/share/none/a.png"), HasSubstr("apt-get install none-data")));
}

TEST(World, PicturesAreWhereTheirPackagesPutThem) {
  int packages = 0;
  for (const auto& pictures : {world_photographs(), world_drawings()})
    for (const WorldPicture& picture : pictures) {
      if (!std::filesystem::exists(fmt::format("/usr/share/doc/{}", picture.package))) continue;
      ++packages;
      EXPECT_EQ(missing_picture_problem(picture), "");
    }
  if (packages == 0) GTEST_SKIP() << "none of the packages is installed";
}

}  // namespace
}  // namespace saccade
