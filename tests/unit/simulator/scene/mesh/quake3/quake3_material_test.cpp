#include <gmock/gmock.h>

#include <string>

#include "core/error.h"
#include "core/io/files/zip_archive.h"
#include "core/io/images/png_file.h"
#include "core/srgb.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/mesh/quake3/quake3_map_file.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Quake3MapFile;

/// A game of three archives: maps, and two with pictures and scripts.
class Quake3Game : public testing::MeshFiles {
 protected:
  fs::path picture(int code) const {
    return write(std::to_string(code) + ".png",
                 encode_png(ImageU8(2, 2, static_cast<std::uint8_t>(code))));
  }
  fs::path map(const std::vector<std::string>& shaders) const {
    Quake3MapFile file;
    for (std::size_t i = 0; i < shaders.size(); ++i)
      file.add_square(file.add_shader(shaders[i]), static_cast<float>(i));
    file.end_model();
    return write("m.bsp", file.bytes());
  }
  fs::path archive_with(const std::vector<std::string>& shaders) const {
    const fs::path archive = folder_ / "maps.pk3";
    write_zip(archive, {{"maps/m.bsp", map(shaders)}});
    return archive.string() + "!/maps/m.bsp";
  }
  static double grey_at(const Mesh& mesh, std::size_t triangle) {
    return mesh.materials[mesh.triangles[triangle].material].texture->at_texel(0, 0);
  }
};

TEST_F(Quake3Game, PicturesComeFromTheArchivesBesideTheMap) {
  write_zip(folder_ / "a.pk3",
            {{"textures/wall.png", picture(10)}, {"textures/floor.png", picture(20)}});
  write_zip(folder_ / "b.pk3", {{"Textures/Wall.PNG", picture(200)}});
  MeshImporter importer;
  const Mesh mesh = importer.read(archive_with({"textures/wall", "textures/floor"}));
  ASSERT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(grey_at(mesh, 0), linear_from_srgb8(200), 1e-6) << "the last archive is the newest";
  EXPECT_NEAR(grey_at(mesh, 2), linear_from_srgb8(20), 1e-6);
  EXPECT_THAT(importer.remarks().lines(),
              ElementsAre(HasSubstr("surfaces show their base colour; not shown: baked light")));
}

TEST_F(Quake3Game, ScriptsNamePictures) {
  const fs::path script = write("s.shader",
                                "textures/wall\n{\n{\nmap $lightmap\n}\n{\nmap pictures/p.tga\n"
                                "blendFunc filter\ntcMod scale 2 4\n}\n}\n"
                                "textures/glow\n{\n{\nmap pictures/p.tga\nblendFunc add\n}\n}\n");
  write_zip(folder_ / "a.pk3", {{"scripts/s.shader", script}, {"pictures/p.png", picture(50)}});
  MeshImporter importer;
  const Mesh mesh = importer.read(archive_with({"textures/Wall", "textures/glow"}));
  ASSERT_EQ(mesh.triangles.size(), 2U) << "what adds light is left out";
  EXPECT_NEAR(grey_at(mesh, 0), linear_from_srgb8(50), 1e-6);
  EXPECT_EQ(mesh.uvs[0], Eigen::Vector2d(0, 1)) << "the picture's upper left corner stays";
  EXPECT_EQ(mesh.uvs[2], Eigen::Vector2d(2, -3));
}

TEST_F(Quake3Game, AMapOnTheDiskHasItsPicturesBesideItsFolder) {
  fs::create_directories(folder_ / "maps");
  fs::create_directories(folder_ / "textures");
  fs::copy_file(picture(70), folder_ / "textures/wall.png");
  fs::copy_file(map({"textures/wall"}), folder_ / "maps/m.bsp");
  MeshImporter importer;
  EXPECT_NEAR(grey_at(importer.read(folder_ / "maps/m.bsp"), 0), linear_from_srgb8(70), 1e-6);
}

TEST_F(Quake3Game, AMissingPictureIsAnErrorOrGreyInOneLine) {
  const fs::path file = archive_with({"textures/wall", "textures/floor", "textures/roof"});
  const std::string problem =
      testing::error_of([&] { static_cast<void>(MeshImporter().read(file)); });
  EXPECT_THAT(problem, HasSubstr("maps.pk3!/maps/m.bsp: its texture 'textures/wall'"));
  EXPECT_THAT(problem, HasSubstr("scene.missing_texture: grey"));
  MeshImporter importer({MissingTexture::kGrey, false});
  const Mesh mesh = importer.read(file);
  EXPECT_EQ(mesh.materials[mesh.triangles[0].material].albedo, 0.5);
  EXPECT_THAT(importer.remarks().lines(),
              ElementsAre(HasSubstr("missing pictures are grey 0.5: textures/wall and 2 more"),
                          HasSubstr("baked light")));
}

TEST_F(Quake3Game, AnArchiveAloneNamesItsMaps) {
  static_cast<void>(archive_with({"textures/wall"}));
  const std::string problem =
      testing::error_of([&] { static_cast<void>(MeshImporter().read(folder_ / "maps.pk3")); });
  EXPECT_THAT(problem, HasSubstr("is an archive of 1 maps: name one of them"));
  EXPECT_THAT(problem, HasSubstr("maps.pk3!/maps/m.bsp"));
}

TEST_F(Quake3Game, WhatElseLiesBesideTheMapDoesNotStopIt) {
  write("junk.pk3", "no archive");
  fs::create_directories(folder_ / "folder.pk3");
  write_zip(folder_ / "A.PK3", {{"textures/wall.png", picture(30)}});
  MeshImporter importer;
  EXPECT_NEAR(grey_at(importer.read(archive_with({"textures/wall"})), 0), linear_from_srgb8(30),
              1e-6);
  EXPECT_THAT(importer.remarks().lines(),
              ElementsAre(HasSubstr("junk.pk3"), HasSubstr("baked light")));
}

TEST_F(Quake3Game, AMapMayBeNamedFromWithinItsFolder) {
  fs::create_directories(folder_ / "maps");
  fs::create_directories(folder_ / "textures");
  fs::copy_file(picture(70), folder_ / "textures/wall.png");
  fs::copy_file(map({"textures/wall"}), folder_ / "maps/m.bsp");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "maps");
  for (const char* name : {"m.bsp", "./m.bsp", "../maps/m.bsp"})
    EXPECT_NEAR(grey_at(MeshImporter().read(name), 0), linear_from_srgb8(70), 1e-6) << name;
  fs::current_path(before);
}

TEST_F(Quake3Game, ADamagedMapNamesItsFile) {
  EXPECT_THAT(testing::error_of(
                  [&] { static_cast<void>(MeshImporter().read(write("m.bsp", "IBSP damaged"))); }),
              HasSubstr("m.bsp: is no map of Quake III Arena"));
}

}  // namespace
}  // namespace saccade
