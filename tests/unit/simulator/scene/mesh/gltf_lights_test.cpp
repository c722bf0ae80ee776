#include "simulator/scene/mesh/gltf_lights.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/config/config.h"
#include "core/error.h"
#include "core/srgb.h"
#include "simulator/scene/build_scene.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using nlohmann::json;
using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A white triangle at y = 0 that faces +y, under a sun, a bulb and a spot. The spot's
/// node is turned and moved within another that is, too.
json lit_floor() {
  return json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
    "nodes": [
      {"mesh": 0, "scale": [20, 1, 20], "translation": [-10, 0, 10]},
      {"rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
       "extensions": {"KHR_lights_punctual": {"light": 0}}},
      {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 1}}},
      {"translation": [0, 4, 0], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476],
       "scale": [2, 2, 2], "children": [4]},
      {"matrix": [1, 0, 0, 0,  0, 0, -1, 0,  0, 1, 0, 0,  0, 0.5, -2, 1],
       "extensions": {"KHR_lights_punctual": {"light": 2}}}],
    "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [
      {"name": "sun", "type": "directional", "intensity": 3},
      {"name": "bulb", "type": "point", "color": [1, 0.5, 0], "intensity": 40},
      {"name": "lamp", "type": "spot", "intensity": 100,
       "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.6}}]}},
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "mode": 4,
                                "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
       "min": [0, 0, -2], "max": [2, 0, 0]},
      {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 36}],
    "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAADAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAA"}]})");
}

json& light_of(json& document, std::size_t index) {
  return document["extensions"]["KHR_lights_punctual"]["lights"][index];
}

class GltfLights : public testing::MeshFiles {
 protected:
  std::vector<LightOptions> read(const json& document,
                                 ColourChannel channel = ColourChannel::kLuminance) const {
    MeshImporter importer({.channel = channel, .takes_lights = true});
    return importer.read(write("floor.gltf", document.dump())).lights;
  }

  std::string error_of(const json& document) const {
    try {
      static_cast<void>(read(document));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  Scene scene(const std::string& yaml) const {
    return build_scene(config::read<SceneOptions>(config::parse(yaml, "scene.yaml", folder_)));
  }

  static double radiance(const Scene& scene, const Ray& ray) {
    TriangleId triangle = kNothing;
    scene.visible({&ray, 1}, {&triangle, 1});
    return scene.shade(ray, triangle).radiance;
  }
};

TEST_F(GltfLights, StandWhereTheirNodesPutThem) {
  const std::vector<LightOptions> lights = read(lit_floor());
  ASSERT_EQ(lights.size(), 3U);
  const LightOptions &sun = lights[0], &bulb = lights[1], &lamp = lights[2];

  EXPECT_EQ(sun.type, LightType::kDirectional);
  EXPECT_NEAR((sun.direction - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(sun.intensity, 3);

  EXPECT_EQ(bulb.type, LightType::kPoint);
  EXPECT_EQ(bulb.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(bulb.intensity, 40 * static_cast<double>(luminance(1.0F, 0.5F, 0.0F)), 1e-12);

  // The lamp's matrix turns -z to -y and moves by (0, 0.5, -2), its parent doubles that, turns it
  // about y, z to x, and lifts it by 4.
  EXPECT_EQ(lamp.type, LightType::kSpot);
  EXPECT_NEAR((lamp.position - Eigen::Vector3d(-4, 5, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((lamp.direction - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(lamp.intensity, 100);
  EXPECT_NEAR(lamp.inner_angle_deg, 0.2 * 180 / pi, 1e-12);
  EXPECT_NEAR(lamp.outer_angle_deg, 0.6 * 180 / pi, 1e-12);
}

TEST_F(GltfLights, HaveTheExtensionsDefaults) {
  json document = lit_floor();
  light_of(document, 2) = {{"type", "spot"}};
  const LightOptions lamp = read(document).at(2);
  EXPECT_EQ(lamp.intensity, 1);
  EXPECT_EQ(lamp.inner_angle_deg, 0);
  EXPECT_NEAR(lamp.outer_angle_deg, 45, 1e-12);
}

TEST_F(GltfLights, ShowTheirColourInAChannel) {
  EXPECT_EQ(read(lit_floor(), ColourChannel::kRed).at(1).intensity, 40);
  EXPECT_EQ(read(lit_floor(), ColourChannel::kGreen).at(1).intensity, 20);
  EXPECT_EQ(read(lit_floor(), ColourChannel::kBlue).at(1).intensity, 0);
}

// As programs write it that know a sharp cone.
TEST_F(GltfLights, ConesWithoutFalloffAreAlmostSharp) {
  json document = lit_floor();
  light_of(document, 2)["spot"] = {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}};
  const LightOptions lamp = read(document).at(2);
  EXPECT_NEAR(lamp.outer_angle_deg - lamp.inner_angle_deg, kLeastFalloff_deg, 1e-12);
}

TEST_F(GltfLights, ThatAreWrongAreErrorsThatNameThem) {
  const auto error_with = [this](std::size_t light, const char* key, const json& value) {
    json document = lit_floor();
    light_of(document, light)[key] = value;
    return error_of(document);
  };
  EXPECT_THAT(error_with(1, "intensity", -2),
              AllOf(HasSubstr("floor.gltf"), HasSubstr("'bulb'"), HasSubstr("intensity -2")));
  EXPECT_THAT(error_with(1, "color", {1, -1, 0}), AllOf(HasSubstr("'bulb'"), HasSubstr("colour")));
  EXPECT_THAT(error_with(0, "type", "directionl"),
              AllOf(HasSubstr("'sun'"), HasSubstr("did you mean 'directional'?")));
  EXPECT_THAT(error_with(0, "type", "area"), HasSubstr("directional, point, spot"));
  EXPECT_THAT(error_with(2, "spot", {{"innerConeAngle", 0.7}, {"outerConeAngle", 0.6}}),
              AllOf(HasSubstr("'lamp'"), HasSubstr("innerConeAngle")));
  EXPECT_THAT(error_with(2, "spot", {{"outerConeAngle", 2}}), HasSubstr("outerConeAngle"));
  EXPECT_THAT(error_with(2, "intensity", "bright"), HasSubstr("lights cannot be read"));
  json document = lit_floor();
  document["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 7;
  EXPECT_THAT(error_of(document), HasSubstr("light 7, of 3"));
}

// E of the sun, bulb and lamp on the floor below the lamp: closed forms, in the world of z up.
TEST_F(GltfLights, LightTheSceneWhereTheMeshStands) {
  write("floor.gltf", lit_floor().dump());
  const std::string mesh =
      "meshes: [{file: floor.gltf, up: y, transform: {translation: [10, 0, 1]}}]\n"
      "lighting: lambertian\nambient: 0.25\n";
  // The bulb is at (11, -3, 3), the lamp at (6, 0, 6), the floor at z = 1.
  const Ray down{{6, 0, 3}, {0, 0, -1}};
  EXPECT_NEAR(radiance(scene(mesh), down), 0.25, 1e-6);
  const double bulb =
      40 * static_cast<double>(luminance(1.0F, 0.5F, 0.0F)) * 2 / std::pow(25 + 9 + 4, 1.5);
  const double lux = 3 + bulb + 100.0 / 25;
  EXPECT_NEAR(radiance(scene(mesh + "lights_from_meshes: true\n"), down), 0.25 + lux / pi, 1e-5);
  EXPECT_NEAR(radiance(scene(mesh + "lights_from_meshes: true\nlight_scale: 0.01\n"), down),
              0.25 + 0.01 * lux, 1e-5);
  const Ray outside{{6, 4, 3}, {0, 0, -1}};  // at 38.7 degrees off the lamp's axis
  const double outer_bulb =
      40 * static_cast<double>(luminance(1.0F, 0.5F, 0.0F)) * 2 / std::pow(25 + 49 + 4, 1.5);
  EXPECT_NEAR(radiance(scene(mesh + "lights_from_meshes: true\n"), outside),
              0.25 + (3 + outer_bulb) / pi, 1e-5);
  EXPECT_NEAR(
      radiance(scene(mesh + "lights_from_meshes: true\nlights: [{type: directional, direction: "
                            "[0, 0, -1], intensity: 2}]\n"),
               down),
      2.25 + lux / pi, 1e-5)
      << "beside those that the scene states";
}

TEST_F(GltfLights, AreRemarkedWhereTheyDoNotLight) {
  write("floor.gltf", lit_floor().dump());
  const auto warnings_of = [this](const std::string& mesh, const std::string& keys) {
    ::testing::internal::CaptureStderr();
    static_cast<void>(scene("meshes: [{file: floor.gltf, up: y" + mesh + "}]\n" + keys));
    return ::testing::internal::GetCapturedStderr();
  };
  const std::string takes = "lighting: lambertian\nlights_from_meshes: true\n";
  const std::string moves =
      ", trajectory: {source: waypoints, waypoints: [[0, 0, 0, 0, 0, 0, 0, 1], [1, 0, 0, 1, 0, 0, "
      "0, 1]]}";
  EXPECT_THAT(warnings_of("", ""),
              AllOf(HasSubstr("KHR_lights_punctual"), HasSubstr("scene.lights_from_meshes")));
  EXPECT_EQ(warnings_of("", takes), "");
  EXPECT_THAT(warnings_of(moves, takes),
              AllOf(HasSubstr("floor.gltf"), HasSubstr("scene.meshes[0] has a trajectory")));
}

TEST_F(GltfLights, AreAtMost64WithThoseOfTheScene) {
  write("floor.gltf", lit_floor().dump());
  std::string lights;
  for (int k = 0; k < 62; ++k) lights += "  - {position: [0, 0, 1]}\n";
  try {
    static_cast<void>(
        scene("meshes: [{file: floor.gltf, up: y}]\nlighting: lambertian\n"
              "lights_from_meshes: true\nlights:\n" +
              lights));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("65"), HasSubstr("at most 64")));
  }
}

}  // namespace
}  // namespace saccade
