#include "simulator/scene/scene_builder.h"
#include "simulator/scene/build_scene.h"
#include "simulator/scene/mesh_placement.h"

#include <gmock/gmock.h>

#include <limits>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SceneFile : public testing::MeshFiles {
 protected:
  SceneOptions options(const std::string& yaml) const {
    return config::read<SceneOptions>(config::parse(yaml, "scene.yaml", folder_));
  }
  std::string error_of(const std::string& yaml) const {
    try {
      static_cast<void>(build_scene(options(yaml)));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  static Shade see(const Scene& scene, const Ray& ray) {
    TriangleId triangle = kNothing;
    scene.visible({&ray, 1}, {&triangle, 1});
    return scene.shade(ray, triangle);
  }
};

TEST_F(SceneFile, PlacesMeshesAndShowsTheBackground) {
  write("square.obj", testing::square_obj("square.mtl"));
  write("square.mtl", "newmtl surface\nKd 1 1 1\n");
  const Scene scene = build_scene(options(
      "meshes:\n"
      "  - {file: square.obj, transform: {translation: [0, 0, 3], scale: 2}}\n"
      "  - {file: square.obj, transform: {translation: [5, 0, 4], rotation_deg: [0, 0, 90]}}\n"
      "background: 0.125\n"));
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(see(scene, {{1.9, 1.9, 0}, forward}).distance, 3, 1e-12);
  EXPECT_NEAR(see(scene, {{1.9, 1.9, 0}, forward}).radiance, 1, 1e-6);
  EXPECT_NEAR(see(scene, {{4.5, 0.5, 0}, forward}).distance, 4, 1e-12);
  EXPECT_NEAR(see(scene, {{5.5, 0.5, 0}, forward}).radiance, 0.125, 1e-12);
}

TEST_F(SceneFile, FilesCanBeYUp) {
  write("square.obj", testing::square_obj("square.mtl"));
  write("square.mtl", "newmtl surface\nKd 1 1 1\n");
  // The square of x and y stands upright, twice as wide as it is high.
  const Scene scene =
      build_scene(options("meshes: [{file: square.obj, up: y, size_m: [2, 1, 1], "
                          "transform: {translation: [0, 3, 0]}}]\nbackground: 0.125\n"));
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(see(scene, {{1.9, 0, 0.9}, forward}).distance, 3, 1e-12);
  EXPECT_NEAR(see(scene, {{1.9, 0, 1.1}, forward}).radiance, 0.125, 1e-12);
  EXPECT_NEAR(see(scene, {{2.1, 0, 0.9}, forward}).radiance, 0.125, 1e-12);
}

TEST_F(SceneFile, GltfWithoutItsUpAxisIsRemarked) {
  write("square.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const auto warnings_of = [this](const std::string& mesh_keys) {
    ::testing::internal::CaptureStderr();
    static_cast<void>(build_scene(options("meshes: [{file: square.gltf" + mesh_keys + "}]")));
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(warnings_of(", up: y"), "");
  EXPECT_EQ(warnings_of(", up: z"), "");
  EXPECT_EQ(warnings_of(", transform: {rotation_deg: [90, 0, 0]}"), "");
  EXPECT_THAT(warnings_of(""),
              AllOf(HasSubstr("warning: "), HasSubstr("square.gltf"), HasSubstr("up: y")));
  EXPECT_EQ(warnings_of(""), "") << "a line is shown once";
}

TEST_F(SceneFile, MissingTexturesAreErrorsUnlessTheyMayBeGrey) {
  write("square.obj", testing::square_obj("square.mtl"));
  write("square.mtl", "newmtl surface\nmap_Kd nowhere.png\n");
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]"), HasSubstr("nowhere.png"));
  ::testing::internal::CaptureStderr();
  const Scene scene = build_scene(options("meshes: [{file: square.obj}]\nmissing_texture: grey\n"));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("nowhere.png"));
  EXPECT_NEAR(see(scene, {{0.5, 0.5, 1}, -Eigen::Vector3d::UnitZ()}).radiance, 0.5, 1e-12);
}

TEST_F(SceneFile, LambertianLightIsRead) {
  write("square.obj", testing::square_obj("square.mtl"));
  write("square.mtl", "newmtl surface\nKd 1 1 1\n");
  const Scene scene = build_scene(
      options("meshes: [{file: square.obj}]\nlighting: lambertian\nambient: 0.25\nlights:\n"
              "  - {type: directional, direction: [0, 0, -2], intensity: 0.5}\n"
              "  - {type: point, position: [0.5, 0.5, 2], intensity: 4, shadows: false}\n"));
  EXPECT_NEAR(see(scene, {{0.5, 0.5, 1}, -Eigen::Vector3d::UnitZ()}).radiance, 0.25 + 0.5 + 1,
              1e-6);
}

TEST_F(SceneFile, SurfacesCanGlowUnderLights) {
  write("square.obj", testing::square_obj());
  Mesh mesh = MeshImporter().read(folder_ / "square.obj");
  const Ray down{{0.5, 0.5, 1}, -Eigen::Vector3d::UnitZ()};
  const auto radiance = [&](double self_light) {
    for (Material& material : mesh.materials) material.self_light = self_light;
    SceneBuilder builder;
    builder.add(mesh, Eigen::Affine3d::Identity());
    LightOptions light{.type = LightType::kDirectional, .intensity = 0.5};
    builder.light(0.25, {light});
    const Scene scene = std::move(builder).build(Background(0));
    return see(scene, down).radiance / mesh.colours.front();
  };
  EXPECT_NEAR(radiance(0), 0.75, 1e-6);
  EXPECT_NEAR(radiance(2), 2.75, 1e-6);
  EXPECT_NEAR(radiance(std::numeric_limits<double>::infinity()), 1, 1e-6);
}

TEST_F(SceneFile, EnvironmentMapIsRead) {
  write("square.obj", testing::square_obj());
  write_exr(folder_ / "sky.exr", ImageF(8, 4, 3.5F), "Y");
  const Scene scene = build_scene(options("meshes: [{file: square.obj}]\nbackground: sky.exr\n"));
  EXPECT_NEAR(see(scene, {{5, 5, 5}, {1, 2, 3}}).radiance, 3.5, 1e-6);
}

TEST_F(SceneFile, PrintsWhatItReads) {
  write("square.obj", testing::square_obj());
  const std::string yaml =
      "meshes: [{file: square.obj, size_m: [1, 2, 3], anchor: bottom, transform: {rotation_deg: "
      "[90, 0, 0]}}, {file: square.obj, transform: {scale: [1, 2, 3]}}]\nbackground: 0.25\n"
      "lighting: lambertian\nlights_from_meshes: true\nlight_scale: 2\n"
      "lights: [{type: directional, direction: [1, 0, 0]}, {type: spot, position: [1, 2, 3], "
      "direction: [1, 0, 0], inner_angle_deg: 10, outer_angle_deg: 20}]\n";
  const std::string printed = config::print(options(yaml));
  EXPECT_EQ(config::print(options(printed)), printed);
}

/// Two squares, each an object of its own.
std::string two_squares_obj() {
  return "o left\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
         "o right\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\nf 5 6 7 8\n";
}

TEST_F(SceneFile, InstancesAndClassesFollowTheMeshes) {
  write("two.obj", two_squares_obj());
  const Scene scene = build_scene(options(
      "meshes:\n"
      "  - {file: two.obj, class: table, transform: {translation: [0, 0, 3]}}\n"
      "  - {file: two.obj, instances: nodes, class: chair, transform: {translation: [0, 2, 3]}}\n"
      "  - {file: two.obj, transform: {translation: [0, 4, 3]}}\n"
      "  - {file: two.obj, class: table, transform: {translation: [0, 6, 3]}}\n"));
  const auto instance_at = [&](double x, double y) {
    const Ray ray{{x, y, 0}, Eigen::Vector3d::UnitZ()};
    TriangleId triangle = kNothing;
    scene.visible({&ray, 1}, {&triangle, 1});
    return scene.instance(triangle);
  };
  EXPECT_EQ(instance_at(0.5, 0.5), 1);
  EXPECT_EQ(instance_at(2.5, 0.5), 1);
  EXPECT_EQ(instance_at(0.5, 2.5), 2);
  EXPECT_EQ(instance_at(2.5, 2.5), 3);
  EXPECT_EQ(instance_at(2.5, 4.5), 4);
  EXPECT_EQ(instance_at(0.5, 6.5), 5);
  EXPECT_EQ(instance_at(1.5, 0.5), 0);
  ASSERT_EQ(scene.instances().size(), 5U);
  EXPECT_EQ(scene.instances()[1].name, "two/left");
  EXPECT_EQ(scene.instances()[2].name, "two/right");
  EXPECT_EQ(scene.instances()[2].object, 1U);
  EXPECT_EQ(scene.instances()[3].name, "two");
  const std::vector<int> classes{0, 1, 2, 2, 0, 1};
  for (std::uint16_t k = 0; k < 6; ++k) EXPECT_EQ(scene.class_of(k), classes[k]) << k;
}

TEST_F(SceneFile, ClassesHaveTheNumbersThatAListGivesThem) {
  write("two.obj", two_squares_obj());
  const std::string mesh = "meshes: [{file: two.obj, class: chair}]\n";
  const Scene scene = build_scene(options(mesh + "classes: [table, lamp, chair]\n"));
  EXPECT_EQ(scene.class_of(1), 3);
  EXPECT_THAT(error_of(mesh + "classes: [table, chairs]\n"),
              AllOf(HasSubstr("scene.yaml:2"), HasSubstr("did you mean 'chairs'?")));
  EXPECT_THAT(error_of(mesh + "classes: [chair, chair]\n"), HasSubstr("hold a name twice"));
  EXPECT_THAT(error_of("meshes: [{file: two.obj, instances: node}]\n"),
              HasSubstr("did you mean 'nodes'?"));
}

TEST_F(SceneFile, MoreMeshesFollowTheOthers) {
  write("two.obj", two_squares_obj());
  const SceneOptions both =
      options("meshes: [{file: two.obj, class: a}]\nmore_meshes: [{file: two.obj, class: b}]\n");
  ASSERT_EQ(both.meshes.size(), 2U);
  EXPECT_EQ(both.meshes[1].class_name, "b");
  EXPECT_EQ(class_names(both), (std::vector<std::string>{"a", "b"}));
  const SceneOptions again = options(config::print(both));
  EXPECT_EQ(again.meshes.size(), 2U);
}

TEST_F(SceneFile, TheSurfaceOfAMeshCanBeReplaced) {
  write("square.obj", testing::square_obj("square.mtl"));
  write("square.mtl", "newmtl surface\nKd 1 1 1\n");
  write("plain.obj", two_squares_obj());
  write("a.texture.yaml", "size_m: [1, 1]\ntexels_per_m: 16\nseed: 5\n");
  write("b.texture.yaml", "size_m: [1, 1]\ntexels_per_m: 16\nseed: 6\n");
  const auto radiances = [&](const std::string& keys) {
    const Scene scene = build_scene(
        options("meshes: [{file: square.obj" + keys + ", transform: {translation: [0, 0, 3]}}]\n"));
    std::vector<double> all;
    for (const double x : {0.1, 0.4, 0.7})
      for (const double y : {0.2, 0.5, 0.8})
        all.push_back(see(scene, {{x, y, 0}, Eigen::Vector3d::UnitZ()}).radiance);
    return all;
  };
  EXPECT_NEAR(radiances("").at(4), 1, 1e-6);
  EXPECT_NEAR(radiances(", reflectance: 0.25").at(4), 0.25, 1e-6);
  const std::vector<double> a = radiances(", texture: a.texture.yaml");
  EXPECT_NE(a, radiances(", texture: b.texture.yaml"));
  EXPECT_EQ(a, radiances(", texture: b.texture.yaml, texture_seed: 5"));
  const std::vector<double> half = radiances(", texture: a.texture.yaml, reflectance: 0.5");
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(half[i], 0.5 * a[i], 1e-12);
  EXPECT_THAT(error_of("meshes: [{file: plain.obj, texture: a.texture.yaml}]\n"),
              HasSubstr("plain.obj: has no texture coordinates"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj, texture: none.png}]\n"),
              HasSubstr("scene.yaml:1"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj, texture_seed: 1}]\n"),
              HasSubstr("needs a 'texture' that is a *.texture.yaml"));
}

TEST_F(SceneFile, MalformedScenesAreErrorsWithTheirPlace) {
  write("square.obj", testing::square_obj());
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_THAT(error_of("meshes: [{file: nowhere.obj}]"),
              AllOf(HasSubstr("scene.yaml:1"), HasSubstr("nowhere.obj")));
  EXPECT_THAT(error_of("meshes: [{file: flat.obj}]"),
              AllOf(HasSubstr("flat.obj"), HasSubstr("area")));
  EXPECT_THAT(error_of("meshes: []"), HasSubstr("scene.yaml:1"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj, transform: {scale: 0}}]"), HasSubstr("scale"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj, size_m: [1, 0, 1]}]"), HasSubstr("size_m"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj, size_m: [1, 1, 1], transform: {scale: 2}}]"),
              HasSubstr("size_m"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nbackground: -1"), HasSubstr("background"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nbackground: sky.exr"), HasSubstr("sky.exr"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nlighting: bright"), HasSubstr("lambertian"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nambient: 1"), HasSubstr("lambertian"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nlighting: lambertian\nlights: [{type: "
                       "directional, direction: [0, 0, 0]}]"),
              HasSubstr("direction"));
  const std::string lit = "meshes: [{file: square.obj}]\nlighting: lambertian\nlights: [{";
  const std::string spot = lit + "type: spot, position: [0, 0, 1], ";
  EXPECT_THAT(error_of(lit + "type: spto, position: [0, 0, 1]}]"), HasSubstr("spot"));
  EXPECT_THAT(error_of(lit + "type: spot, direction: [0, 0, -1]}]"), HasSubstr("position"));
  EXPECT_THAT(error_of(spot + "intensity: 1}]"), HasSubstr("direction"));
  EXPECT_THAT(error_of(spot + "direction: [0, 0, 0]}]"), HasSubstr("direction"));
  EXPECT_THAT(error_of(spot + "direction: [0, 0, -1], intensity: -1}]"), HasSubstr("intensity"));
  EXPECT_THAT(error_of(spot + "direction: [0, 0, -1], inner_angle_deg: 30, outer_angle_deg: 20}]"),
              AllOf(HasSubstr("scene.yaml:3"), HasSubstr("outer_angle_deg")));
  EXPECT_THAT(error_of(spot + "direction: [0, 0, -1], outer_angle_deg: 91}]"),
              HasSubstr("outer_angle_deg"));
  EXPECT_THAT(error_of(lit + "position: [0, 0, 1], outer_angle_deg: 20}]"), HasSubstr("spot"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nlights_from_meshes: true"),
              HasSubstr("lambertian"));
  EXPECT_THAT(error_of("meshes: [{file: square.obj}]\nlighting: lambertian\nlight_scale: 2"),
              HasSubstr("lights_from_meshes"));
}

TEST_F(SceneFile, MissingFurnitureSaysHowToGetIt) {
  EXPECT_THAT(error_of("meshes: [{file: '/usr/share/sweethome3d/nowhere.sh3f!/desk.obj'}]"),
              AllOf(HasSubstr("scene.yaml:1"), HasSubstr("apt-get install sweethome3d-furniture")));
}

TEST(WorldFromMesh, ScalesThenRotatesThenTranslates) {
  MeshOptions options;
  options.transform.scale = {2, 3, 4};
  options.transform.rotation_deg = {90, 0, 90};
  options.transform.translation = {10, 20, 30};
  const Eigen::Affine3d placed = world_from_mesh(options, {});
  // x stays under Rx and becomes y under Rz; y becomes z; z becomes -y, then x.
  EXPECT_LT((placed * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(10, 22, 30)).norm(), 1e-12);
  EXPECT_LT((placed * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(10, 20, 33)).norm(), 1e-12);
  EXPECT_LT((placed * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(14, 20, 30)).norm(), 1e-12);
}

TEST(WorldFromMesh, SizeIsThatOfTheBoxAndAnchorsTakeItInPlace) {
  Mesh mesh;
  mesh.vertices = {{1, 1, 1}, {3, 1, 1}, {3, 2, 6}};
  mesh.triangles = {{{0, 1, 2}, 0}};
  MeshOptions options;
  options.size_m = Eigen::Vector3d(0.5, 0.5, 0.5);
  options.transform.rotation_deg = {90, 0, 0};
  options.transform.translation = {1, 2, 3};
  options.anchor = Anchor::kBottom;
  const Eigen::Affine3d placed = world_from_mesh(options, mesh);
  Eigen::AlignedBox3d box;
  for (int i = 0; i < 3; ++i) box.extend(placed * mesh.vertices[static_cast<std::size_t>(i)]);
  EXPECT_LT((box.min() - Eigen::Vector3d(0.75, 1.75, 3)).norm(), 1e-12);
  EXPECT_LT((box.max() - Eigen::Vector3d(1.25, 2.25, 3.5)).norm(), 1e-12);
}

}  // namespace
}  // namespace saccade
