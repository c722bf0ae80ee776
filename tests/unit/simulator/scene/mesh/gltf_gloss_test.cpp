// What glTF says of roughness and metalness.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/images/image_file.h"
#include "core/srgb.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "simulator/scene/scene_options.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GltfGloss : public testing::MeshFiles {
 protected:
  /// The material of a triangle with this pbrMetallicRoughness.
  Material material(const json& surface, bool is_taken = true) {
    json document = json::parse(R"({
      "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
      "textures": [{"source": 0}], "images": [{"uri": "rough.png"}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
         "min": [0, 0, -2], "max": [2, 0, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 24}],
      "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAADA"}]})");
    document["materials"] = {{{"pbrMetallicRoughness", surface}, {"extensions", extensions_}}};
    const std::filesystem::path file = write("t.gltf", document.dump());
    MeshImportOptions options;
    options.is_lit = true;
    options.takes_gloss = is_taken;
    options.missing_texture = missing_;
    MeshImporter importer(options);
    const Mesh mesh = importer.read(file);
    remarks_ = importer.remarks().lines();
    return mesh.materials.at(mesh.triangles.at(0).material);
  }
  MissingTexture missing_ = MissingTexture::kError;
  json extensions_ = json::object();
  std::vector<std::string> remarks_;
};

TEST_F(GltfGloss, AMetalMirrorsItsColourAndOthersFourPercent) {
  const Material plastic = material({{"metallicFactor", 0}, {"roughnessFactor", 0.5}});
  EXPECT_FLOAT_EQ(plastic.gloss.reflectance, 0.04F);
  EXPECT_FLOAT_EQ(plastic.gloss.alpha, 0.25F);
  EXPECT_THAT(remarks_, IsEmpty());
  const Material steel = material({{"baseColorFactor", {0.6, 0.6, 0.6, 1}}});
  EXPECT_FLOAT_EQ(steel.gloss.reflectance, 0.6F);
  EXPECT_FLOAT_EQ(steel.gloss.alpha, 1);
  const Material half =
      material({{"baseColorFactor", {0.6, 0.6, 0.6, 1}}, {"metallicFactor", 0.5}});
  EXPECT_FLOAT_EQ(half.gloss.reflectance, 0.32F);
}

TEST_F(GltfGloss, AMetalUnderAPictureMirrorsTheMeanOfIt) {
  write("rough.png", encode_png(ImageU8(2, 2, 128)));
  const Material bronze =
      material({{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"baseColorTexture", {{"index", 0}}}});
  EXPECT_NEAR(bronze.gloss.reflectance, 0.5 * linear_from_srgb8(128), 1e-6);
}

TEST_F(GltfGloss, WhatIsUnlitIsMatt) {
  extensions_ = {{"KHR_materials_unlit", json::object()}};
  EXPECT_TRUE(material({{"roughnessFactor", 0.5}}).gloss.is_matt());
}

TEST_F(GltfGloss, IsLeftOutWithOneLineByDefault) {
  EXPECT_TRUE(material({{"roughnessFactor", 0.5}}, false).gloss.is_matt());
  EXPECT_THAT(remarks_, ElementsAre(HasSubstr("metallic reflection")));
}

TEST_F(GltfGloss, OfAPictureTheMeanCounts) {
  // Half of the texels rough (green) and metallic (blue), the others smooth.
  ImageRgb8 codes(2, 2);
  codes(0, 0) = codes(1, 1) = {0, 255, 255};
  write("rough.png", encode_png(codes));
  const Material worn = material({{"baseColorFactor", {0.6, 0.6, 0.6, 1}},
                                  {"roughnessFactor", 0.8},
                                  {"metallicRoughnessTexture", {{"index", 0}}}});
  EXPECT_NEAR(worn.gloss.reflectance, 0.32, 1e-6);
  EXPECT_NEAR(worn.gloss.alpha, 0.16, 1e-6);
  EXPECT_THAT(remarks_, ElementsAre(HasSubstr("their mean counts")));
}

TEST_F(GltfGloss, AMissingPictureIsAnErrorOrLeavesTheFactors) {
  const json surface{{"metallicFactor", 0},
                     {"roughnessFactor", 0.5},
                     {"metallicRoughnessTexture", {{"index", 0}}}};
  EXPECT_THAT(testing::error_of([&] { return material(surface); }), HasSubstr("rough.png"));
  missing_ = MissingTexture::kGrey;
  EXPECT_FLOAT_EQ(material(surface).gloss.alpha, 0.25F);
  EXPECT_THAT(remarks_, ::testing::Contains(HasSubstr("count without it")));
}

TEST_F(GltfGloss, AMeshWithoutLightsMirrorsNothing) {
  write("a.obj", testing::square_obj());
  const auto options = [&](const std::string& lighting) {
    return config::read<SceneOptions>(config::parse(
        "meshes: [{file: " + (folder_ / "a.obj").string() +
            ", gloss: {reflectance: 0.1, roughness: 0.2}}]\nlighting: " + lighting + "\n",
        "scene.yaml"));
  };
  EXPECT_THAT(testing::error_of([&] { return options("none"); }),
              HasSubstr("'gloss' without lights to mirror"));
  EXPECT_EQ(options("lambertian").meshes.at(0).gloss->roughness, 0.2);
}

TEST_F(GltfGloss, TheSceneStatesTheGlossOfAnyMesh) {
  MeshImporter importer;
  const Mesh mesh = importer.with_surface(importer.read(write("a.obj", testing::square_obj())),
                                          {{}, {}, 1, make_gloss(0.1, 0.5)}, "a.obj");
  EXPECT_FLOAT_EQ(mesh.materials.at(0).gloss.reflectance, 0.1F);
  EXPECT_FLOAT_EQ(mesh.materials.at(0).gloss.alpha, 0.25F);
}

}  // namespace
}  // namespace saccade
