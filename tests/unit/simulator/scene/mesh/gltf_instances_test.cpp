#include "simulator/scene/mesh/gltf_instances.h"

#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <limits>

#include "core/error.h"
#include "simulator/scene/mesh/base64.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GltfInstances : public testing::MeshFiles {
 protected:
  /// A triangle under a node that is moved by (0, 0, 5), in two places: at (1, 2, 3), and turned by
  /// 180 degrees about z and twice as large at the origin.
  json two_trees() {
    const std::vector<float> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0,  // the triangle
                                     1, 2, 3, 0, 0, 0,           // where
                                     0, 0, 0, 1, 0, 0, 1, 0,     // how turned
                                     1, 1, 1, 2, 2, 2};          // how large
    Bytes bytes(numbers.size() * sizeof(float));
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    json document = json::parse(R"({
      "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "extensionsUsed": ["EXT_mesh_gpu_instancing"],
      "extensionsRequired": ["EXT_mesh_gpu_instancing"],
      "nodes": [{"translation": [0, 0, 5], "children": [1]},
                {"name": "tree", "mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {
                  "attributes": {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3}}}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
         "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 2, "type": "VEC3"},
        {"bufferView": 0, "byteOffset": 60, "componentType": 5126, "count": 2, "type": "VEC4"},
        {"bufferView": 0, "byteOffset": 92, "componentType": 5126, "count": 2, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 116}]})");
    document["buffers"] = {{{"byteLength", bytes.size()},
                            {"uri", "data:application/octet-stream;base64," + base64_of(bytes)}}};
    return document;
  }
  Mesh read(const json& document) {
    MeshImporter importer;
    Mesh mesh = importer.read(write("t.gltf", document.dump()));
    remarks_ = importer.remarks().lines();
    return mesh;
  }
  std::vector<std::string> remarks_;
};

TEST_F(GltfInstances, AMeshStandsInAllItsPlaces) {
  const Mesh mesh = read(two_trees());
  EXPECT_THAT(remarks_, IsEmpty());
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_THAT(mesh.nodes, ElementsAre("tree", "tree"));
  const auto corner = [&](std::size_t triangle, std::size_t k) {
    return mesh.vertices[mesh.triangles[triangle].corners[k]];
  };
  EXPECT_TRUE(corner(0, 1).isApprox(Eigen::Vector3d(2, 2, 8), 1e-6));
  EXPECT_TRUE(corner(1, 1).isApprox(Eigen::Vector3d(-2, 0, 5), 1e-6));
  EXPECT_TRUE(corner(1, 2).isApprox(Eigen::Vector3d(0, -2, 5), 1e-6));
}

TEST_F(GltfInstances, OnePartOfAPlaceIsEnough) {
  json document = two_trees();
  json& attributes = document["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes.erase("ROTATION");
  attributes.erase("SCALE");
  EXPECT_EQ(read(document).triangles.size(), 2U);
}

TEST_F(GltfInstances, PlacesThatDoNotFitAreErrors) {
  const auto problem = [&](const std::function<void(json&)>& change) {
    json document = two_trees();
    change(document);
    return testing::error_of([&] { return read(document); });
  };
  EXPECT_THAT(problem([](json& d) { d["accessors"][3]["count"] = 1; }),
              HasSubstr("t.gltf: cannot be read as glTF: the places of its node 1 differ"));
  EXPECT_THAT(problem([](json& d) {
                d["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
                    json::object();
              }),
              HasSubstr("its node 1 states no places"));
  EXPECT_THAT(problem([](json& d) {
                d["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 9;
              }),
              HasSubstr("it has no accessor 9"));
  EXPECT_THAT(problem([](json& d) { d["accessors"][1]["type"] = "SCALAR"; }),
              HasSubstr("accessor 1 is not of 3 numbers"));
}

TEST_F(GltfInstances, PlacesThatAreNotFiniteOrNoneAtAll) {
  json document = two_trees();
  std::vector<float> numbers(6, std::numeric_limits<float>::quiet_NaN());
  const GltfAccess access{[&](std::size_t, std::size_t) { return numbers; },
                          [](const std::string& problem) { throw InputError("t.gltf", problem); }};
  document["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", 1}};
  EXPECT_THAT(testing::error_of([&] {
                expand_gltf_instances(access, document);
                return 0;
              }),
              HasSubstr("a place of its node 1 is not finite"));
  numbers.clear();
  expand_gltf_instances(access, document);
  EXPECT_FALSE(document["nodes"][1].contains("mesh"));
  EXPECT_EQ(document["nodes"].size(), 2U);
}

TEST_F(GltfInstances, ACrowdIsRefused) {
  json document = two_trees();
  const GltfAccess access{
      [](std::size_t, std::size_t) { return std::vector<float>(3 * 60'000, 0.0F); },
      [](const std::string& problem) { throw InputError("t.gltf", problem); }};
  document["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", 1}};
  document["nodes"].push_back(document["nodes"][1]);
  EXPECT_THAT(testing::error_of([&] {
                expand_gltf_instances(access, document);
                return 0;
              }),
              HasSubstr("more than 100000 places"));
}

}  // namespace
}  // namespace saccade
