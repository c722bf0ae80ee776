#include "simulator/scene/mesh/mesh_import.h"

#include <gmock/gmock.h>
#include <zip.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/io/files/input_log.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/srgb.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kFurnitureFile = "/usr/share/sweethome3d/furniture/Scopia.sh3f";

class MeshImport : public testing::MeshFiles {
 protected:
  Mesh read(const std::string& name) const { return MeshImporter().read(folder_ / name); }

  std::string error_of(const std::string& name) const {
    try {
      static_cast<void>(read(name));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  /// A square whose material is given by the lines of its library.
  void write_square(const std::string& material_lines) const {
    write("square.obj", testing::square_obj("square.mtl"));
    write("square.mtl", "newmtl surface\n" + material_lines);
  }

  Material square_material(const std::string& material_lines) const {
    write_square(material_lines);
    const Mesh mesh = read("square.obj");
    return mesh.materials.at(mesh.triangles.at(0).material);
  }
};

TEST_F(MeshImport, ReadsTrianglesInTheFilesOwnAxes) {
  write("square.obj", testing::square_obj());
  const Mesh mesh = read("square.obj");
  EXPECT_EQ(mesh.triangles.size(), 2U);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  EXPECT_EQ(box.min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(box.max(), Eigen::Vector3d(1, 1, 0));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR((mesh.uvs[i] - mesh.vertices[i].head<2>()).norm(), 0, 1e-7);
    EXPECT_NEAR(std::abs(mesh.normals[i].z()), 1, 1e-6);
  }
}

TEST_F(MeshImport, ColourIsDecodedToLinearGrey) {
  const Material material = square_material("Kd 0.5 0.25 1\n");
  const double expected = 0.2126 * linear_from_srgb(0.5) + 0.7152 * linear_from_srgb(0.25) + 0.0722;
  EXPECT_NEAR(material.albedo, expected, 1e-6);
  EXPECT_EQ(material.texture, nullptr);
}

TEST_F(MeshImport, ATextureReplacesTheColour) {
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  const Material material = square_material("Kd 0.1 0.1 0.1\nmap_Kd grey.png\n");
  ASSERT_NE(material.texture, nullptr);
  EXPECT_NEAR(material.factor * material.texture->at(0.3, 0.3), linear_from_srgb(128 / 255.0),
              1e-6);
}

TEST_F(MeshImport, ColourTexturesBecomeLuminance) {
  write_png(folder_ / "red.png", ImageRgb8(2, 2, Rgb8{255, 0, 0}));
  EXPECT_NEAR(square_material("map_Kd red.png\n").texture->at(0.5, 0.5), 0.2126, 1e-6);
}

TEST_F(MeshImport, OpenExrIsLinearAndKeepsItsValues) {
  write_exr(folder_ / "bright.exr", ImageF(3, 2, 7.25F), "Y");
  EXPECT_NEAR(square_material("map_Kd bright.exr\n").texture->at(0.5, 0.5), 7.25, 1e-6);
}

TEST_F(MeshImport, RadianceHdrIsLinear) {
  std::string bright = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
  for (int i = 0; i < 16; ++i) bright += "\x80\x80\x80\x82";  // 128 / 256 * 2^(130 - 128)
  write("bright.hdr", bright);
  EXPECT_NEAR(square_material("map_Kd bright.hdr\n").texture->at(0.5, 0.5), 2, 0.02);
}

TEST_F(MeshImport, NormalMapsOfOtherFormatsCountUnderLights) {
  write_png(folder_ / "bumps.png", ImageRgb8(2, 2, Rgb8{255, 0, 255}));
  write("surface.mtl", "newmtl surface\nnorm -clamp on bumps.png\n");
  MeshImporter lit({.is_lit = true});
  const Mesh mesh = lit.read(write("square.obj", testing::square_obj("surface.mtl")));
  const auto map = mesh.materials.at(mesh.triangles.at(0).material).normal_map;
  ASSERT_NE(map, nullptr);
  EXPECT_LT((map->at_texel(0, 0, 0) - Eigen::Vector3d(1, -1, 1)).norm(), 1e-6);
  EXPECT_EQ(map->part(0).wrap_u(), Wrap::kClamp);
  EXPECT_TRUE(lit.remarks().lines().empty());
  EXPECT_THAT(error_of("square.obj"), HasSubstr("no error"));
}

TEST_F(MeshImport, WrapModeComesFromTheMaterial) {
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  EXPECT_EQ(square_material("map_Kd grey.png\n").texture->wrap_u(), Wrap::kRepeat);
  EXPECT_EQ(square_material("map_Kd -clamp on grey.png\n").texture->wrap_u(), Wrap::kClamp);
}

TEST_F(MeshImport, NamesFromWindowsAreFound) {
  std::filesystem::create_directories(folder_ / "maps");
  write_png(folder_ / "maps" / "grey.png", ImageU8(2, 2, 128));
  EXPECT_NE(square_material("map_Kd maps\\grey.png\n").texture, nullptr);
}

TEST_F(MeshImport, TexturesAreFoundBesideTheMeshAndInOtherCase) {
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  EXPECT_NE(square_material("map_Kd C:\\work\\maps\\grey.png\n").texture, nullptr);
  EXPECT_NE(square_material("map_Kd /home/me/grey.png\n").texture, nullptr);
  EXPECT_NE(square_material("map_Kd GREY.PNG\n").texture, nullptr);
}

TEST_F(MeshImport, ParametersOfATextureAreGenerated) {
  write("tiles.texture.yaml", "size_m: [0.4, 0.2]\ntexels_per_m: 100\n");
  const Material material = square_material("map_Kd tiles.texture.yaml\n");
  ASSERT_NE(material.texture, nullptr);
  EXPECT_EQ(material.texture->width(), 40);
  EXPECT_EQ(material.texture->height(), 20);
}

TEST_F(MeshImport, AlphaChannelsAndMapsCutOut) {
  ImageRgba8 alpha(2, 2, Rgba8{200, 200, 200, 255});
  alpha(0, 0)[3] = 0;
  write("leaf.png", encode_png(alpha));
  write_png(folder_ / "mask.png", ImageU8(2, 2, 255));
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  const Material leaf = square_material("map_Kd leaf.png\n");
  ASSERT_NE(leaf.opacity, nullptr);
  EXPECT_DOUBLE_EQ(leaf.opacity->at(0.25, 0.75), 0);
  EXPECT_NE(square_material("map_Kd grey.png\nmap_d mask.png\n").opacity, nullptr);
  EXPECT_EQ(square_material("map_Kd grey.png\n").opacity, nullptr);
}

TEST_F(MeshImport, SurfacesBelowHalfOpacityAreNotThere) {
  write_square("Kd 1 1 1\nd 0.49\n");
  EXPECT_THAT(error_of("square.obj"), HasSubstr("holds no visible triangle"));
  write_square("Kd 1 1 1\nd 0.51\n");
  EXPECT_EQ(read("square.obj").triangles.size(), 2U);
}

TEST_F(MeshImport, UnusedMaterialsNeedNoFiles) {
  write_square("Kd 1 1 1\nnewmtl unused\nmap_Kd nowhere.png\n");
  EXPECT_EQ(read("square.obj").triangles.size(), 2U);
}

TEST_F(MeshImport, ColoursOfPlyVerticesAreRead) {
  write("square.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255 255 255\n1 0 0 0 0 0\n0 "
        "1 0 128 128 128\n3 0 1 2\n");
  const Mesh mesh = read("square.ply");
  std::vector<double> colours = mesh.colours;
  std::ranges::sort(colours);
  EXPECT_NEAR(colours.front(), 0, 1e-6);
  EXPECT_NEAR(colours[1], linear_from_srgb(128 / 255.0), 1e-5);
  EXPECT_NEAR(colours.back(), 1, 1e-6);
}

TEST_F(MeshImport, ReadsFromWithinAnArchive) {
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  const std::string obj = testing::square_obj("square.mtl");
  const std::string mtl = "newmtl surface\nmap_Kd maps/grey.png\n";
  const std::string archive = (folder_ / "things.zip").string();
  zip_t* zip = zip_open(archive.c_str(), ZIP_CREATE, nullptr);
  const auto add = [&](const char* name, const std::string& text) {
    zip_file_add(zip, name, zip_source_buffer(zip, text.data(), text.size(), 0), 0);
  };
  add("square/square.obj", obj);
  add("square/square.mtl", mtl);
  zip_file_add(zip, "square/maps/grey.png",
               zip_source_file(zip, (folder_ / "grey.png").c_str(), 0, 0), 0);
  ASSERT_EQ(zip_close(zip), 0);

  const Mesh mesh = read("things.zip!/square/square.obj");
  const Material& material = mesh.materials[mesh.triangles[0].material];
  ASSERT_NE(material.texture, nullptr);
  EXPECT_NEAR(material.texture->at(0.5, 0.5), linear_from_srgb(128 / 255.0), 1e-6);
  EXPECT_THAT(error_of("things.zip!/square/round.obj"),
              AllOf(HasSubstr("things.zip!/square/round.obj"), HasSubstr("not in this archive")));
}

TEST_F(MeshImport, ReadsFurnitureInPlace) {
  if (!std::filesystem::exists(kFurnitureFile))
    GTEST_SKIP() << kFurnitureFile << " is missing: apt-get install sweethome3d-furniture";
  const Mesh mesh =
      MeshImporter().read(std::string(kFurnitureFile) + "!/scopia/wardrobe1/wardrobe1.obj");
  EXPECT_GT(mesh.triangles.size(), 500U);
  EXPECT_TRUE(
      std::ranges::any_of(mesh.materials, [](const Material& m) { return m.texture != nullptr; }));
}

TEST_F(MeshImport, MalformedFilesAreNamed) {
  EXPECT_THAT(error_of("nowhere.obj"), AllOf(HasSubstr("nowhere.obj"), HasSubstr("not exist")));
  write("text.xyz", "nothing");
  EXPECT_THAT(error_of("text.xyz"), AllOf(HasSubstr("text.xyz"), HasSubstr("format '.xyz'")));
  write("empty.obj", "");
  EXPECT_THAT(error_of("empty.obj"), HasSubstr("empty.obj"));
  write("points.obj", "v 0 0 0\nv 1 0 0\n");
  EXPECT_THAT(error_of("points.obj"), HasSubstr("points.obj"));
  write("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  EXPECT_THAT(error_of("nan.obj"), AllOf(HasSubstr("nan.obj"), HasSubstr("not finite")));
  write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  EXPECT_THAT(error_of("beyond.obj"), HasSubstr("beyond.obj"));
  write("noise.glb", "glTF and then nonsense");
  EXPECT_THAT(error_of("noise.glb"), HasSubstr("noise.glb"));
  write("broken.zip", "PK nonsense");
  EXPECT_THAT(error_of("broken.zip!/a.obj"),
              AllOf(HasSubstr("broken.zip"), HasSubstr("zip archive")));
  EXPECT_THAT(error_of("nowhere.zip!/a.obj"), HasSubstr("nowhere.zip does not exist"));
}

TEST_F(MeshImport, MalformedMaterialsAreNamed) {
  write("square.obj", testing::square_obj("nowhere.mtl"));
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("square.obj"), HasSubstr("nowhere.mtl")));
  write_square("map_Kd nowhere.png\n");
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("square.obj"), HasSubstr("nowhere.png")));
  write_square("map_Kd broken.png\n");
  write("broken.png", "\x89PNG\r\n nonsense");
  EXPECT_THAT(error_of("square.obj"), HasSubstr("broken.png"));
  write_square("map_Kd dark.exr\n");
  write_exr(folder_ / "dark.exr", ImageF(2, 2, -1.0F), "Y");
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("dark.exr"), HasSubstr("-1")));
  write_square("map_Kd odd.texture.yaml\n");
  write("odd.texture.yaml", "seed: 1\nshapse: {}\n");
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("odd.texture.yaml:2"), HasSubstr("shapes")));
}

TEST_F(MeshImport, MissingTexturesCanBeGrey) {
  MeshImportOptions options;
  options.missing_texture = MissingTexture::kGrey;
  MeshImporter importer(options);
  write_square("map_Kd nowhere.png\nmap_d nomask.png\n");
  const Mesh mesh = importer.read(folder_ / "square.obj");
  const Material& material = mesh.materials.at(mesh.triangles.at(0).material);
  EXPECT_EQ(material.texture, nullptr);
  EXPECT_EQ(material.opacity, nullptr);
  EXPECT_DOUBLE_EQ(material.albedo, 0.5);
  for (const double colour : mesh.colours) EXPECT_DOUBLE_EQ(colour, 0.5);
  EXPECT_THAT(
      importer.remarks().lines(),
      ElementsAre(AllOf(HasSubstr("nowhere.png"), HasSubstr("grey 0.5")), HasSubstr("nomask.png")));
}

TEST_F(MeshImport, SaysInOneLineWhatAMaterialStatesThatIsNotShown) {
  MeshImporter importer;
  write_square("Kd 0.5 0.5 0.5\nKe 0.2 0 0\nmap_bump bump.png\n");
  static_cast<void>(importer.read(folder_ / "square.obj"));
  EXPECT_THAT(
      importer.remarks().lines(),
      ElementsAre(AllOf(HasSubstr("square.obj"), HasSubstr("bump maps"), HasSubstr("emission"))));
  MeshImporter silent;
  write_square("Kd 0.5 0.5 0.5\nKe 0 0 0\n");
  static_cast<void>(silent.read(folder_ / "square.obj"));
  EXPECT_TRUE(silent.remarks().lines().empty());
}

TEST_F(MeshImport, LightSlightlyBelowZeroIsZero) {
  ImageF image(3, 2, 10.0F);
  image(1, 1) = -0.09F;
  write_exr(folder_ / "ringing.exr", image, "Y");
  write_square("map_Kd ringing.exr\n");
  MeshImporter importer;
  const Mesh mesh = importer.read(folder_ / "square.obj");
  EXPECT_DOUBLE_EQ(mesh.materials.at(mesh.triangles.at(0).material).texture->at_texel(1, 1), 0);
  EXPECT_THAT(importer.remarks().lines(),
              ElementsAre(AllOf(HasSubstr("ringing.exr"), HasSubstr("1 texels"))));
  image(1, 1) = -0.11F;
  write_exr(folder_ / "ringing.exr", image, "Y");
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("ringing.exr"), HasSubstr("(1, 1)")));
  image(1, 1) = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder_ / "ringing.exr", image, "Y");
  EXPECT_THAT(error_of("square.obj"), AllOf(HasSubstr("ringing.exr"), HasSubstr("nan")));
}

TEST_F(MeshImport, TgaAndDdsTexturesAreDecoded) {
  write("grey.tga", std::string("\0\0\x03\0\0\0\0\0\0\0\0\0\x01\0\x01\0\x08\0", 18) + "\x80");
  EXPECT_NEAR(square_material("map_Kd grey.tga\n").texture->at(0.5, 0.5),
              linear_from_srgb(128 / 255.0), 1e-6);
  std::string dds(128, '\0');
  dds.replace(0, 4, "DDS ");
  dds[12] = dds[16] = 4;
  dds[80] = 4;
  dds.replace(84, 4, "DXT1");
  write("white.dds", dds + std::string("\xFF\xFF\0\0\0\0\0\0", 8));
  EXPECT_NEAR(square_material("map_Kd white.dds\n").texture->at(0.5, 0.5), 1, 1e-6);
}

TEST_F(MeshImport, AnImporterThatCrashesIsAnError) {
  // assimp's FBX parser calls itself for every brace, until the stack is full.
  constexpr int kDepth = 200'000;
  std::string nested = "; FBX 7.4.0 project file\n";
  for (int i = 0; i < kDepth; ++i) nested += "A: {\n";
  for (int i = 0; i < kDepth; ++i) nested += "}\n";
  write("nested.fbx", nested);
  EXPECT_THAT(error_of("nested.fbx"),
              AllOf(HasSubstr("nested.fbx"), HasSubstr("importer"), HasSubstr("crashed")));
}

TEST_F(MeshImport, AnImporterThatDiesIsAnError) {
  // assimp reads the number of vertices, 353535235358, as another one. Depending on how it was built it fails an
  // assertion or runs out of memory.
  write("many.off",
        "OFF\n353535235358 6 0\n-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n-1 1 -1\n1 1 -1\n-1 -1 -1\n"
        "1 -1 -1\n4 0 1 3 2\n4 2 3 5 4\n4 4 5 7 6\n4 6 7 1 0\n4 1 7 5 3\n4 6 0 2 4\n");
  EXPECT_THAT(error_of("many.off"), AllOf(HasSubstr("many.off"),
                                          AnyOf(HasSubstr("cannot be read"), HasSubstr("memory"))));
}

TEST_F(MeshImport, FilesOfTheImporterAreNoted) {
  write_square("Kd 1 1 1\n");
  const InputLog log;
  static_cast<void>(read("square.obj"));
  const auto files = log.files();
  EXPECT_TRUE(files.contains((folder_ / "square.obj").string()));
  EXPECT_TRUE(files.contains((folder_ / "square.mtl").string()));
}

TEST_F(MeshImport, ATextureNeedsCoordinates) {
  write_png(folder_ / "grey.png", ImageU8(2, 2, 128));
  write("bare.obj", "mtllib square.mtl\nusemtl surface\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("square.mtl", "newmtl surface\nmap_Kd grey.png\n");
  EXPECT_THAT(error_of("bare.obj"), AllOf(HasSubstr("bare.obj"), HasSubstr("'surface'"),
                                          HasSubstr("texture coordinates")));
}

}  // namespace
}  // namespace saccade
