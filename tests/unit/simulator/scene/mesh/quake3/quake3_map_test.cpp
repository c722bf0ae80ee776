#include "simulator/scene/mesh/quake3/quake3_map.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh/quake3/quake3_map_file.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using testing::Quake3MapFile;

Model read(const std::string& bytes) { return read_quake3_map(Bytes(bytes.begin(), bytes.end())); }

std::string problem_of(const std::string& bytes) {
  try {
    static_cast<void>(read(bytes));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

Eigen::Vector3f at(const ModelPart& part, std::uint32_t corner) {
  return Eigen::Vector3f(part.vertices[corner].data());
}

TEST(Quake3Map, APolygonIsInMetresWithItsTextureUpright) {
  Quake3MapFile file;
  file.add_square(file.add_shader("textures/wall"), 64);
  file.end_model();
  const Model model = read(file.bytes());
  ASSERT_EQ(model.parts.size(), 1U);
  const ModelPart& part = model.parts.front();
  EXPECT_EQ(model.materials[part.material].name, "textures/wall");
  EXPECT_THAT(part.vertices[2], ElementsAre(1, 1, 2));
  EXPECT_THAT(part.uvs.front()[2], ElementsAre(1, 0));
  ASSERT_EQ(part.triangles.size(), 2U);
  for (const auto& [a, b, c] : part.triangles)
    EXPECT_GT((at(part, b) - at(part, a)).cross(at(part, c) - at(part, a)).z(), 0)
        << "turns against its normals";
}

TEST(Quake3Map, WhatIsNotDrawnIsLeftOut) {
  Quake3MapFile file;
  file.add_square(file.add_shader("textures/wall"));
  file.add_square(file.add_shader("textures/sky", 0x4));
  file.add_square(file.add_shader("textures/trigger", 0x80));
  file.add_face(4, 0, {}, {});  // a flare
  file.end_model();
  const Model model = read(file.bytes());
  ASSERT_EQ(model.parts.size(), 1U);
  EXPECT_EQ(model.parts.front().triangles.size(), 2U);
}

// Control points of a quarter of a cylinder around the z axis. Its curve is a parabola through both
// ends; each point of it has x + y between 1 and sqrt(2) of the radius.
TEST(Quake3Map, ACurvedFaceIsDividedAlongItsCurve) {
  Quake3MapFile file;
  std::vector<Quake3MapFile::Vertex> control;
  for (int row = 0; row < 3; ++row) {
    const auto z = static_cast<float>(16 * row);
    const auto v = static_cast<float>(row) / 2;
    control.push_back({{32, 0, z}, {0, v}, {1, 0, 0}});
    control.push_back({{32, 32, z}, {0.5F, v}, {1, 1, 0}});
    control.push_back({{0, 32, z}, {1, v}, {0, 1, 0}});
  }
  file.add_face(2, file.add_shader("textures/pipe"), control, {}, {3, 3});
  file.end_model();
  const Model model = read(file.bytes());
  ASSERT_EQ(model.parts.size(), 1U);
  const ModelPart& part = model.parts.front();
  EXPECT_EQ(part.vertices.size(), 81U);
  EXPECT_EQ(part.triangles.size(), 128U);
  for (std::size_t i = 0; i < part.vertices.size(); ++i) {
    const auto& [x, y, z] = part.vertices[i];
    const float t = part.uvs.front()[i][0];  // linear in the curve's parameter
    EXPECT_THAT(x, FloatNear(1 - t * t, 1e-6F));
    EXPECT_THAT(y, FloatNear(1 - (1 - t) * (1 - t), 1e-6F));
    EXPECT_THAT(z, FloatNear(1 - part.uvs.front()[i][1], 1e-6F));
  }
}

TEST(Quake3Map, ACurveThatEndsInAPointHasNoTriangleWithoutArea) {
  Quake3MapFile file;
  std::vector<Quake3MapFile::Vertex> control;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      control.push_back({{static_cast<float>(16 * row * column), static_cast<float>(16 * row), 0},
                         {0, 0},
                         {0, 0, 1}});
  file.add_face(2, file.add_shader("textures/cone"), control, {}, {3, 3});
  file.end_model();
  const Model model = read(file.bytes());
  EXPECT_EQ(model.parts.front().triangles.size(), 128U - 8U);
}

TEST(Quake3Map, EntitiesWithSurfacesAreNodesInTheirPlaces) {
  Quake3MapFile file;
  const std::int32_t shader = file.add_shader("textures/wall");
  file.add_square(shader);
  file.end_model();
  file.add_square(shader);
  file.end_model();
  file.entities +=
      "{\n\"classname\" \"func_door\"\n\"model\" \"*1\"\n\"origin\" \"32 -64 8\"\n}\n"
      "{ \"classname\" \"light\" \"origin\" \"0 0 0\" }";
  const Model model = read(file.bytes());
  EXPECT_THAT(model.nodes, ElementsAre("worldspawn", "func_door *1"));
  ASSERT_EQ(model.instances.size(), 2U);
  const auto& place = model.instances[1].file_from_part;
  EXPECT_THAT(std::vector<double>(place.begin() + 12, place.begin() + 15),
              ElementsAre(1, -2, 0.25));
  EXPECT_EQ(model.lights, 1U);
}

TEST(Quake3Map, PlayersBeginAsCameras) {
  Quake3MapFile file;
  file.add_square(file.add_shader("textures/wall"));
  file.end_model();
  file.entities +=
      "{ \"classname\" \"info_player_deathmatch\" \"origin\" \"64 32 6\" \"angle\" \"90\" }"
      "{ \"classname\" \"info_player_intermission\" \"angles\" \"30 180 0\" }";
  const Model model = read(file.bytes());
  ASSERT_EQ(model.cameras.size(), 2U);
  EXPECT_THAT(model.cameras[0].position, ElementsAre(2, 1, 1));
  EXPECT_NEAR(model.cameras[0].forward[1], 1, 1e-12);
  EXPECT_NEAR(model.cameras[1].forward[0], -std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(model.cameras[1].forward[2], -0.5, 1e-12) << "looks downwards";
  for (const ModelCamera& camera : model.cameras)
    EXPECT_NEAR(Eigen::Vector3d(camera.forward.data()).dot(Eigen::Vector3d(camera.up.data())), 0,
                1e-12);
}

TEST(Quake3Map, DamageIsAnErrorThatSaysWhat) {
  const auto with = [](const std::function<void(Quake3MapFile&)>& change) {
    Quake3MapFile file;
    const std::int32_t shader = file.add_shader("textures/wall");
    file.add_square(shader);
    change(file);
    file.end_model();
    return problem_of(file.bytes());
  };
  const Quake3MapFile::Vertex vertex{{0, 0, 0}, {0, 0}, {0, 0, 1}};
  EXPECT_EQ(with([](Quake3MapFile&) {}), "none");
  EXPECT_THAT(with([](Quake3MapFile& f) { f.version = 38; }), HasSubstr("of version 38"));
  EXPECT_THAT(with([&](Quake3MapFile& f) { f.add_face(1, 7, {vertex}, {}); }),
              HasSubstr("a face is of shader 7"));
  EXPECT_THAT(with([&](Quake3MapFile& f) {
                f.add_face(1, 0, {vertex}, {0, 0, 1});
              }),
              HasSubstr("a face has no corner 1"));
  EXPECT_THAT(with([&](Quake3MapFile& f) {
                f.add_face(2, 0, {vertex}, {}, {1, 1});
              }),
              HasSubstr("has 1 x 1 control points"));
  EXPECT_THAT(
      with([](Quake3MapFile& f) { f.entities += "{ \"classname\" \"a\" \"model\" \"*9\" }"; }),
      HasSubstr("entity 'a' is of model *9"));
  EXPECT_THAT(with([](Quake3MapFile& f) { f.entities += "{ \"classname\""; }), HasSubstr("brace"));
  EXPECT_THAT(with([](Quake3MapFile& f) { f.entities += "{ \"classname"; }),
              HasSubstr("quotation mark"));
  EXPECT_THAT(problem_of("IBSP"), HasSubstr("is no map"));
  EXPECT_THAT(problem_of(std::string(200, 'x')), HasSubstr("is no map"));
}

TEST(Quake3Map, EveryShorterFileIsAnErrorOrHasFewerFaces) {
  Quake3MapFile file;
  file.add_square(file.add_shader("textures/wall"));
  file.end_model();
  const std::string bytes = file.bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(problem_of(bytes.substr(0, size)), "none") << size;
}

TEST(Quake3Map, ACrowdOfFacesIsRefused) {
  Quake3MapFile file;
  const std::int32_t shader = file.add_shader("textures/wall");
  constexpr std::int32_t kSide = 101;
  const std::vector<Quake3MapFile::Vertex> control(std::size_t{kSide} * kSide,
                                                   {{0, 0, 0}, {0, 0}, {0, 0, 1}});
  for (int i = 0; i < 60; ++i) file.add_face(2, shader, control, {}, {kSide, kSide});
  file.end_model();
  EXPECT_THAT(problem_of(file.bytes()), HasSubstr("claims more than 8388608 vertices"));
}

TEST(Quake3Map, ManyTrianglesOfFewVerticesAreRefused) {
  Quake3MapFile file;
  const std::int32_t shader = file.add_shader("textures/wall");
  const Quake3MapFile::Vertex vertex{{0, 0, 0}, {0, 0}, {0, 0, 1}};
  file.add_face(1, shader, {vertex, vertex, vertex},
                std::vector<std::int32_t>(std::size_t{3} << 20U, 0));
  for (int i = 0; i < 2; ++i)
    file.add_face(1, shader, {vertex, vertex, vertex},
                  std::vector<std::int32_t>(std::size_t{3} << 20U, 1));
  file.end_model();
  EXPECT_THAT(problem_of(file.bytes()), HasSubstr("claims more than 8388608 vertices"));
}

TEST(Quake3Map, NamesAreText) {
  Quake3MapFile file;
  file.add_square(file.add_shader("textures/\xff\x01wall"));
  file.end_model();
  file.entities += "{ \"classname\" \"info_player_\xfe\" }";
  const Model model = read(file.bytes());
  EXPECT_EQ(model.materials.front().name, "textures/??wall");
  EXPECT_EQ(model.cameras.front().name, "info_player_? 1");
}

constexpr const char* kOpenArena = "/usr/share/games/openarena/baseoa/pak1-maps.pk3";

TEST(Quake3Map, EveryMapOfOpenArenaLoads) {
  if (!std::filesystem::exists(kOpenArena))
    GTEST_SKIP() << kOpenArena << " is missing: apt-get install openarena-081-maps";
  MeshImporter importer({MissingTexture::kGrey, false});
  std::size_t maps = 0;
  for (const std::filesystem::path& map : FileSource(kOpenArena).list("maps")) {
    if (!is_quake3_map(map)) continue;
    SCOPED_TRACE(map.string());
    const Mesh mesh = importer.read(std::string(kOpenArena) + "!/" + map.string());
    EXPECT_GT(mesh.triangles.size(), 1000U);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
    EXPECT_GT(box.sizes().minCoeff(), 4) << "a player is 1.75 m tall";
    EXPECT_LT(box.sizes().maxCoeff(), 4100) << "of the largest map that the game loads";
    ++maps;
  }
  EXPECT_EQ(maps, 50U);
}

}  // namespace
}  // namespace saccade
