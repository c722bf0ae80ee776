#include "simulator/scene/mesh/gltf_material.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.h"
#include "core/io/images/image_file.h"
#include "core/io/images/webp_file.h"
#include "core/srgb.h"
#include "simulator/scene/mesh/base64.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <class T>
void append(Bytes& bytes, const std::vector<T>& numbers) {
  const std::size_t size = bytes.size();
  bytes.resize(size + numbers.size() * sizeof(T));
  std::memcpy(bytes.data() + size, numbers.data(), numbers.size() * sizeof(T));
}

/// The square [0, 1]^2 at z = 0; texture coordinates (x, 1 - y), downwards as glTF has them.
json square() {
  Bytes bytes;
  append<float>(bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  append<float>(bytes, {0, 1, 1, 1, 1, 0, 0, 0});
  append<std::uint16_t>(bytes, {0, 1, 2, 0, 2, 3});
  json document = json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
                                "material": 0}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
       "min": [0, 0, 0], "max": [1, 1, 0]},
      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [
      {"buffer": 0, "byteOffset": 0, "byteLength": 48},
      {"buffer": 0, "byteOffset": 48, "byteLength": 32},
      {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
    "materials": [{"name": "wall", "pbrMetallicRoughness": {"metallicFactor": 0}}]})");
  document["buffers"] = {{{"byteLength", bytes.size()},
                          {"uri", "data:application/octet-stream;base64," + base64_of(bytes)}}};
  return document;
}

/// A new attribute of the square.
template <class T>
void add_attribute(json& document, const char* name, int component, const char* type,
                   bool is_normalized, const std::vector<T>& numbers) {
  Bytes bytes;
  append(bytes, numbers);
  document["buffers"].push_back(
      {{"byteLength", bytes.size()},
       {"uri", "data:application/octet-stream;base64," + base64_of(bytes)}});
  document["bufferViews"].push_back(
      {{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                   {"componentType", component},
                                   {"normalized", is_normalized},
                                   {"count", 4},
                                   {"type", type}});
  document["meshes"][0]["primitives"][0]["attributes"][name] = document["accessors"].size() - 1;
}

json& material(json& document) { return document["materials"][0]; }

void set_texture(json& document, const std::string& uri) {
  document["images"] = {{{"uri", uri}}};
  document["textures"] = {{{"source", 0}}};
  material(document)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
}

class Gltf : public testing::MeshFiles {
 protected:
  struct Result {
    Mesh mesh;
    std::vector<std::string> remarks;

    [[nodiscard]] const Material& material() const {
      return mesh.materials.at(mesh.triangles.at(0).material);
    }
    /// The radiance of the surface at (x, y), unlit.
    [[nodiscard]] double at(double x, double y) const {
      const Material& shown = material();
      const auto value = [&](const auto& of) {  // bilinear from the corners, which may be repeated
        std::array<double, 4> sums{}, counts{};
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
          const Eigen::Vector3d& p = mesh.vertices[i];
          const std::size_t corner = (p.x() > 0.5 ? 1U : 0U) + (p.y() > 0.5 ? 2U : 0U);
          sums[corner] += of(i);
          counts[corner] += 1;
        }
        double mean = 0;
        for (std::size_t k = 0; k < 4; ++k)
          mean += ((k & 1U) != 0 ? x : 1 - x) * ((k & 2U) != 0 ? y : 1 - y) * sums[k] / counts[k];
        return mean;
      };
      if (shown.texture == nullptr) return value([&](std::size_t i) { return mesh.colours[i]; });
      return shown.factor *
             shown.texture->at(value([&](std::size_t i) { return mesh.uvs[i].x(); }),
                               value([&](std::size_t i) { return mesh.uvs[i].y(); }));
    }
  };

  Result read(const json& document, const MeshImportOptions& options = {}) const {
    MeshImporter importer(options);
    Mesh mesh = importer.read(write("square.gltf", document.dump()));
    return {std::move(mesh), importer.remarks().lines()};
  }

  std::string error_of(const json& document) const {
    try {
      static_cast<void>(read(document));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  /// Grey codes 0, 64, 128, 255: left to right, top to bottom.
  void write_four() const {
    ImageU8 image(2, 2);
    image(0, 0) = 0;
    image(1, 0) = 64;
    image(0, 1) = 128;
    image(1, 1) = 255;
    write_png(folder_ / "four.png", image);
  }
};

double linear(int code) { return linear_from_srgb(code / 255.0); }

TEST_F(Gltf, TextureAndFactorMultiplyInLinearLight) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  material(document)["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
  const Result result = read(document);
  EXPECT_NEAR(result.at(0.25, 0.75), 0, 1e-6);
  EXPECT_NEAR(result.at(0.75, 0.75), 0.5 * linear(64), 1e-6);
  EXPECT_NEAR(result.at(0.25, 0.25), 0.5 * linear(128), 1e-6);
  EXPECT_NEAR(result.at(0.75, 0.25), 0.5, 1e-6);
  EXPECT_THAT(result.remarks, IsEmpty());
}

TEST_F(Gltf, ColouredFactorsMultiplyEachChannel) {
  write_png(folder_ / "red.png", ImageRgb8(2, 2, Rgb8{255, 128, 0}));
  json document = square();
  set_texture(document, "red.png");
  material(document)["pbrMetallicRoughness"]["baseColorFactor"] = {0.25, 0.5, 1, 1};
  EXPECT_NEAR(read(document).at(0.5, 0.5), 0.2126 * 0.25 + 0.7152 * 0.5 * linear(128), 1e-6);
}

TEST_F(Gltf, TextureTransformsAreApplied) {
  // A ramp of u: the value tells where the texture was read.
  ImageU8 ramp(256, 2);
  for (int x = 0; x < 256; ++x) ramp(x, 0) = ramp(x, 1) = static_cast<std::uint8_t>(x);
  write_png(folder_ / "ramp.png", ramp);
  json document = square();
  set_texture(document, "ramp.png");
  json& info = material(document)["pbrMetallicRoughness"]["baseColorTexture"];
  const auto expect_u = [&](double x, double y, double u, const char* what) {
    const int code = static_cast<int>(std::lround(u * 256 - 0.5));
    EXPECT_NEAR(read(document).at(x, y), linear(code), 0.02) << what;
  };
  info["extensions"]["KHR_texture_transform"] = {{"offset", {0.25, 0}}};
  expect_u(0.25, 0.5, 0.5, "offset");
  info["extensions"]["KHR_texture_transform"] = {{"scale", {0.5, 3}}};
  expect_u(0.75, 0.5, 0.375, "scale");
  // u' = u cos + v sin, with v downwards: TextureTransformTest of Khronos' sample models.
  info["extensions"]["KHR_texture_transform"] = {{"rotation", std::numbers::pi / 2}};
  expect_u(0.5, 0.75, 0.25, "rotation");
  info["extensions"]["KHR_texture_transform"] = {
      {"rotation", std::numbers::pi / 2}, {"offset", {0.125, 0}}, {"scale", {1, 0.5}}};
  expect_u(0.5, 0.5, 0.375, "all");
}

TEST_F(Gltf, TextureTransformsChooseTheirCoordinates) {
  write_four();
  json document = square();
  add_attribute<float>(document, "TEXCOORD_1", 5126, "VEC2", false,
                       {0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75});
  set_texture(document, "four.png");
  material(document)["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
                    ["KHR_texture_transform"] = {{"texCoord", 1}};
  EXPECT_NEAR(read(document).at(0.25, 0.75), 1, 1e-6);
}

TEST_F(Gltf, NormalizedCoordinatesAreNumbers) {
  write_four();
  json document = square();
  add_attribute<std::uint16_t>(document, "TEXCOORD_0", 5123, "VEC2", true,
                               {0, 65535, 65535, 65535, 65535, 0, 0, 0});
  set_texture(document, "four.png");
  EXPECT_NEAR(read(document).at(0.75, 0.75), linear(64), 1e-4);
  EXPECT_NEAR(read(document).at(0.75, 0.25), 1, 1e-4);
}

TEST_F(Gltf, WrapModesComeFromTheSampler) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  document["textures"][0]["sampler"] = 0;
  const Result result = read(document);
  EXPECT_EQ(result.material().texture->wrap_u(), Wrap::kClamp);
  EXPECT_EQ(result.material().texture->wrap_v(), Wrap::kMirror);
}

TEST_F(Gltf, WebpTexturesAreDecoded) {
  std::ofstream(folder_ / "grey.webp", std::ios::binary)
      << encode_webp(ImageRgb8(4, 4, Rgb8{128, 128, 128}));
  json document = square();
  set_texture(document, "grey.webp");
  document["extensionsUsed"] = document["extensionsRequired"] = {"EXT_texture_webp"};
  document["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  EXPECT_NEAR(read(document).at(0.5, 0.5), linear(128), 1e-6);
}

TEST_F(Gltf, PicturesInsideTheFileAreDecoded) {
  const std::string png = encode_png(ImageU8(2, 2, 128));
  json document = square();
  set_texture(document, "");
  document["images"][0]["uri"] =
      "data:image/png;base64," + base64_of(Bytes(png.begin(), png.end()));
  EXPECT_NEAR(read(document).at(0.5, 0.5), linear(128), 1e-6);
}

TEST_F(Gltf, BinaryFilesAreRead) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  const std::string text = document.dump() + "   ";
  const std::string chunk = text.substr(0, text.size() / 4 * 4);
  const auto number = [](std::size_t value) {
    std::string bytes;
    for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift);
    return bytes;
  };
  const std::string file =
      "glTF" + number(2) + number(20 + chunk.size()) + number(chunk.size()) + "JSON" + chunk;
  const Mesh mesh = MeshImporter().read(write("square.glb", file));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NE(mesh.materials[mesh.triangles[0].material].texture, nullptr);
}

TEST_F(Gltf, KtxTexturesAreNamed) {
  json document = square();
  set_texture(document, "grey.ktx2");
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_texture_basisu"};
  document["textures"] = {
      {{"name", "brick"}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  EXPECT_THAT(error_of(document), AllOf(HasSubstr("square.gltf"), HasSubstr("texture 0 'brick'"),
                                        HasSubstr("KHR_texture_basisu")));
  document["textures"][0]["source"] = 0;  // the fallback
  write("grey.ktx2", "\xABKTX 20\xBB\r\n\x1A\n");
  EXPECT_THAT(error_of(document), AllOf(HasSubstr("grey.ktx2"), HasSubstr("KTX")));
}

TEST_F(Gltf, UnknownRequiredExtensionsAreNamed) {
  json document = square();
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(error_of(document),
              AllOf(HasSubstr("square.gltf"), HasSubstr("KHR_draco_mesh_compression")));
}

TEST_F(Gltf, VertexColoursAreLinearAndMultiplyTheFactor) {
  json document = square();
  add_attribute<float>(document, "COLOR_0", 5126, "VEC3", false,
                       {1, 1, 1, 0.5, 0.5, 0.5, 0, 0, 0, 0.25, 0.25, 0.25});
  material(document)["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
  const Result result = read(document);
  EXPECT_NEAR(result.at(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(result.at(1, 0), 0.25, 1e-6);
  EXPECT_NEAR(result.at(1, 1), 0, 1e-6);
  EXPECT_NEAR(result.at(0, 1), 0.125, 1e-6);
}

TEST_F(Gltf, VertexColoursOfBytesAreNormalized) {
  json document = square();
  const std::vector<std::uint8_t> codes(16, 51);
  add_attribute<std::uint8_t>(document, "COLOR_0", 5121, "VEC4", true, codes);
  EXPECT_NEAR(read(document).at(0.5, 0.5), 0.2, 1e-6);
}

TEST_F(Gltf, OneVertexColourMultipliesATexture) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  std::vector<float> colours(12, 0.5F);
  add_attribute<float>(document, "COLOR_0", 5126, "VEC3", false, colours);
  Result result = read(document);
  EXPECT_NEAR(result.at(0.75, 0.25), 0.5, 1e-6);
  EXPECT_THAT(result.remarks, IsEmpty());
  colours[0] = 1;
  add_attribute<float>(document, "COLOR_0", 5126, "VEC3", false, colours);
  EXPECT_THAT(read(document).remarks, ElementsAre(HasSubstr("vertex colours over textures")));
}

TEST_F(Gltf, MaskCutsOutAtItsCutoff) {
  write("alpha.tga", std::string("\0\0\x02\0\0\0\0\0\0\0\0\0\x04\0\x01\0\x20\x28", 18) +
                         std::string("\1\1\1\x20\1\1\1\x60\1\1\1\xA0\1\1\1\xE0", 16));
  json document = square();
  set_texture(document, "alpha.tga");
  material(document)["alphaMode"] = "MASK";
  const auto opacity = [&](int i) {
    const Result result = read(document);
    const Texture* texture = result.material().opacity.get();
    return texture == nullptr ? 1.0 : texture->at_texel(i, 0);
  };
  EXPECT_LT(opacity(1), 0.5);
  EXPECT_GE(opacity(2), 0.5);
  material(document)["alphaCutoff"] = 0.8;
  EXPECT_LT(opacity(2), 0.5);
  EXPECT_GE(opacity(3), 0.5);
  material(document)["alphaCutoff"] = 0.1;
  EXPECT_GE(opacity(0), 0.5);
  material(document)["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.2};
  EXPECT_LT(opacity(1), 0.5) << "0.38 * 0.2 < 0.1";
  EXPECT_GE(opacity(2), 0.5);
  material(document)["alphaMode"] = "OPAQUE";
  EXPECT_EQ(opacity(0), 1);
}

TEST_F(Gltf, BlendIsCutOutAtOneHalfAndSaidOnce) {
  json document = square();
  document["materials"].push_back(material(document));
  for (json& item : document["materials"]) {
    item["alphaMode"] = "BLEND";
    item["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.6};
  }
  document["materials"][1]["name"] = "glass";
  json second = document["meshes"][0]["primitives"][0];
  second["material"] = 1;
  document["meshes"][0]["primitives"].push_back(second);
  EXPECT_THAT(read(document).remarks,
              ElementsAre(AllOf(HasSubstr("'wall' and 1 more"), HasSubstr("below 0.5"))));
  document["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.4};
  EXPECT_EQ(read(document).mesh.triangles.size(), 2U);
}

TEST_F(Gltf, EmissionIsAddedToTheRadiance) {
  json document = square();
  material(document)["pbrMetallicRoughness"]["baseColorFactor"] = {0.25, 0.25, 0.25, 1};
  material(document)["emissiveFactor"] = {0.5, 0.5, 0.5};
  EXPECT_NEAR(read(document).at(0.5, 0.5), 0.75, 1e-6);
  material(document)["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 4}};
  EXPECT_NEAR(read(document).at(0.5, 0.5), 2.25, 1e-6);
}

TEST_F(Gltf, EmissiveTexturesAreAdded) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  material(document)["emissiveFactor"] = {1, 1, 1};
  EXPECT_NEAR(read(document).at(0.25, 0.25), 1 + linear(128), 1e-6) << "texture and constant";
  material(document)["emissiveTexture"] = {{"index", 0}};
  EXPECT_NEAR(read(document).at(0.25, 0.25), 2 * linear(128), 1e-6) << "two textures";
  EXPECT_NEAR(read(document).at(0.75, 0.25), 2, 1e-6) << "two textures";
  material(document)["pbrMetallicRoughness"].erase("baseColorTexture");
  EXPECT_NEAR(read(document).at(0.25, 0.25), 1 + linear(128), 1e-6) << "constant and texture";
  EXPECT_THAT(read(document).remarks, IsEmpty());
}

TEST_F(Gltf, EmissionOnOtherCoordinatesIsSaid) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  material(document)["emissiveFactor"] = {1, 1, 1};
  material(document)["emissiveTexture"] = {
      {"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}};
  EXPECT_THAT(read(document).remarks, ElementsAre(HasSubstr("emissive textures")));
}

TEST_F(Gltf, EmissionUnderLightsIsAMultipleOfTheBaseColour) {
  write_four();
  MeshImportOptions lit;
  lit.is_lit = true;
  json document = square();
  json& surface = material(document)["pbrMetallicRoughness"];
  surface["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
  material(document)["emissiveFactor"] = {1, 1, 1};
  EXPECT_NEAR(read(document, lit).material().self_light, 2, 1e-6) << "two constants";
  set_texture(document, "four.png");
  EXPECT_THAT(read(document, lit).remarks, ElementsAre(HasSubstr("no multiple")));
  EXPECT_EQ(read(document, lit).material().self_light, 0);
  material(document)["emissiveTexture"] = {{"index", 0}};
  EXPECT_NEAR(read(document, lit).material().self_light, 2, 1e-6) << "the same texture";
  surface["baseColorFactor"] = {0, 0, 0, 1};
  EXPECT_EQ(read(document, lit).material().self_light, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(read(document, lit).at(0.25, 0.25), linear(128), 1e-6) << "the lamp's own picture";
}

TEST_F(Gltf, NormalMapsCountUnderLights) {
  ImageRgb8 image(2, 2);
  image(0, 0) = {255, 0, 255};
  write_png(folder_ / "bumps.png", image);
  json document = square();
  document["images"] = {{{"uri", "bumps.png"}}};
  document["textures"] = {{{"source", 0}}};
  material(document)["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  EXPECT_THAT(read(document).remarks, ElementsAre(HasSubstr("normal maps (they count under")));
  EXPECT_EQ(read(document).material().normal_map, nullptr);

  MeshImportOptions lit;
  lit.is_lit = true;
  const Result shown = read(document, lit);
  EXPECT_THAT(shown.remarks, IsEmpty());
  ASSERT_NE(shown.material().normal_map, nullptr);
  EXPECT_LT((shown.material().normal_map->at_texel(0, 0, 0) - Eigen::Vector3d(0.5, -0.5, 1)).norm(),
            1e-6);
  EXPECT_EQ(shown.mesh.normal_uvs.size(), shown.mesh.vertices.size());
  lit.takes_normal_maps = false;
  EXPECT_THAT(read(document, lit).remarks, ElementsAre(HasSubstr("scene.normal_maps: true")));
}

TEST_F(Gltf, NormalMapsAreMissedAndRemarked) {
  json document = square();
  document["images"] = {{{"uri", "gone.png"}}};
  document["textures"] = {{{"source", 0}}};
  material(document)["normalTexture"] = {{"index", 0}};
  MeshImportOptions lit;
  lit.is_lit = true;
  EXPECT_THROW(static_cast<void>(read(document, lit)), InputError);
  lit.missing_texture = MissingTexture::kGrey;
  EXPECT_THAT(read(document, lit).remarks,
              ElementsAre(AllOf(HasSubstr("gone.png"), HasSubstr("without its normal map"))));
  document["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  write_four();
  document["images"][0]["uri"] = "four.png";
  try {
    static_cast<void>(read(document, lit));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has a normal map, but its faces have no"));
  }
}

TEST_F(Gltf, StatedTangentsAreTaken) {
  write_four();
  json document = square();
  set_texture(document, "four.png");
  material(document)["normalTexture"] = {{"index", 0}};
  add_attribute<float>(document, "NORMAL", 5126, "VEC3", false,
                       {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  add_attribute<float>(document, "TANGENT", 5126, "VEC4", false,
                       {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1});
  MeshImportOptions lit;
  lit.is_lit = true;
  const Result shown = read(document, lit);
  ASSERT_EQ(shown.mesh.tangents.size(), shown.mesh.vertices.size());
  for (const Eigen::Vector4d& tangent : shown.mesh.tangents)
    EXPECT_EQ(tangent, Eigen::Vector4d(0, 1, 0, -1));
  material(document)["normalTexture"]["extensions"]["KHR_texture_transform"] = {{"rotation", 1}};
  EXPECT_TRUE(read(document, lit).mesh.tangents.at(0).isZero());
}

TEST_F(Gltf, WhatIsNotShownIsSaidInOneLine) {
  json document = square();
  document["textures"] = {{{"source", 0}}};
  document["images"] = {{{"uri", "four.png"}}};
  document["materials"].push_back(material(document));
  document["materials"][0]["normalTexture"] = {{"index", 0}};
  document["materials"][1]["occlusionTexture"] = {{"index", 0}};
  document["materials"][1]["pbrMetallicRoughness"].erase("metallicFactor");
  document["materials"][1]["extensions"]["KHR_materials_clearcoat"] = json::object();
  json second = document["meshes"][0]["primitives"][0];
  second["material"] = 1;
  document["meshes"][0]["primitives"].push_back(second);
  document["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
  EXPECT_THAT(read(document).remarks,
              ElementsAre(AllOf(HasSubstr("square.gltf"), HasSubstr("normal maps"),
                                HasSubstr("occlusion maps"), HasSubstr("metallic"),
                                HasSubstr("KHR_materials_clearcoat"), HasSubstr("animations"))));
}

TEST_F(Gltf, MaterialsKeepTheirIndexWhateverTheOrder) {
  json document = square();
  document["materials"] = json::array();
  for (const double grey : {0.1, 0.2, 0.3, 0.4})
    document["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {grey, grey, grey, 1}}, {"metallicFactor", 0}}}});
  document["meshes"][0]["primitives"][0]["material"] = 2;
  EXPECT_NEAR(read(document).at(0.5, 0.5), 0.3, 1e-6);
  document["meshes"][0]["primitives"][0].erase("material");
  EXPECT_NEAR(read(document).at(0.5, 0.5), 1, 1e-6) << "the default material is white";
}

TEST_F(Gltf, MissingTexturesCanBeGrey) {
  json document = square();
  set_texture(document, "nowhere.png");
  EXPECT_THAT(error_of(document), AllOf(HasSubstr("square.gltf"), HasSubstr("nowhere.png")));
  MeshImportOptions grey;
  grey.missing_texture = MissingTexture::kGrey;
  EXPECT_NEAR(read(document, grey).at(0.5, 0.5), 0.5, 1e-6);
  EXPECT_THAT(read(document, grey).remarks,
              ElementsAre(AllOf(HasSubstr("nowhere.png"), HasSubstr("grey 0.5"))));
}

TEST_F(Gltf, MalformedFilesAreNamed) {
  EXPECT_THAT(error_of({{"asset", {{"version", "2.0"}}}}), HasSubstr("square.gltf"));
  json document = square();
  document["bufferViews"][1]["byteLength"] = 4000;
  document["accessors"][1]["componentType"] = 5121;
  EXPECT_THAT(error_of(document), AllOf(HasSubstr("square.gltf"), HasSubstr("outside")));
  document = square();
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", "a"}};
  EXPECT_THAT(error_of(document), AllOf(HasSubstr("square.gltf"), HasSubstr("material 0")));
  document = square();
  document["nodes"] = 3;
  EXPECT_THAT(error_of(document), HasSubstr("square.gltf"));
  write("square.gltf", "{");
  EXPECT_THROW(static_cast<void>(MeshImporter().read(folder_ / "square.gltf")), InputError);
  write("square.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"a\": " + std::string(100'000, '['));
  EXPECT_THROW(static_cast<void>(MeshImporter().read(folder_ / "square.gltf")), InputError);
}

TEST(Base64, RoundTrip) {
  for (const auto& [text, code] : {std::pair<std::string, std::string>{"", ""},
                                   {"f", "Zg=="},
                                   {"fo", "Zm8="},
                                   {"foo", "Zm9v"},
                                   {"foob", "Zm9vYg=="}}) {  // RFC 4648, section 10
    EXPECT_EQ(base64_of(Bytes(text.begin(), text.end())), code);
    EXPECT_EQ(bytes_of_base64(code), Bytes(text.begin(), text.end()));
  }
  EXPECT_EQ(bytes_of_base64("Zm9!"), std::nullopt);
}

}  // namespace
}  // namespace saccade
