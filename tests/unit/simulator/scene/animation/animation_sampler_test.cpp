#include "simulator/scene/animation/animation_sampler.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "core/error.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/animation/gltf_models.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using testing::GltfModel;
using ::testing::HasSubstr;

class AnimationSampler : public testing::MeshFiles {
 protected:
  Mesh read(const GltfModel& model, const std::string& animation = "") const {
    MeshImporter importer;
    return importer.read(write("model.gltf", model.text()), animation);
  }
  std::string error_of(const GltfModel& model, const std::string& animation = "") const {
    return testing::error_of([&] { static_cast<void>(read(model, animation)); });
  }
};

/// The pose between two of them, as a scene shows it.
Eigen::Vector3d vertex_at(const MeshAnimation& animation, double t_s, std::size_t index) {
  const auto next = std::upper_bound(animation.times_s.begin(), animation.times_s.end(), t_s);
  const auto k = std::min(static_cast<std::size_t>(next - animation.times_s.begin()),
                          animation.times_s.size() - 1) -
                 1;
  const double f = (t_s - animation.times_s[k]) / (animation.times_s[k + 1] - animation.times_s[k]);
  return (1 - f) * animation.vertices[k][index].cast<double>() +
         f * animation.vertices[k + 1][index].cast<double>();
}

/// Of the strip on bones.
Eigen::Vector3d strip_vertex(double x, double y, double t_s) {
  const Eigen::Vector3d rest(x, y, 0);
  const Eigen::Vector3d pivot(1, 0, 0);
  const Eigen::Vector3d turned =
      pivot + Eigen::AngleAxisd(pi * t_s, Eigen::Vector3d::UnitZ()) * (rest - pivot);
  return x < 0.9 ? rest : x > 1.1 ? turned : Eigen::Vector3d(0.5 * (rest + turned));
}

TEST_F(AnimationSampler, SkinnedVerticesAreWhereTheirBonesTakeThem) {
  const Mesh mesh = read(testing::strip_on_bones());
  ASSERT_NE(mesh.animation, nullptr);
  const MeshAnimation& animation = *mesh.animation;
  EXPECT_EQ(animation.name, "move");
  EXPECT_NEAR(animation.duration_s(), 1, 1e-6);
  ASSERT_EQ(mesh.vertices.size(), 18U);
  const double size = std::hypot(2.0, 0.5);
  double largest = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    // assimp may reorder vertices: where they rest tells which one is which.
    const double x = mesh.vertices[i].x(), y = mesh.vertices[i].y();
    for (double t_s = 0; t_s < 1; t_s += 0.00137)
      largest = std::max(largest, (vertex_at(animation, t_s, i) - strip_vertex(x, y, t_s)).norm());
  }
  EXPECT_LT(largest, 1.01 * kChordError * size);
  EXPECT_GT(largest, 0.1 * kChordError * size);  // no more poses than that takes
}

TEST_F(AnimationSampler, WhatIsPlayedIsNotSaidToBeMissing) {
  MeshImporter importer;
  const auto file = write("model.gltf", testing::strip_on_bones().text());
  static_cast<void>(importer.read(file, ""));
  EXPECT_TRUE(importer.remarks().lines().empty());
  static_cast<void>(importer.read(file));
  EXPECT_THAT(importer.remarks().lines(), ::testing::Contains(HasSubstr("animations, skins")));
}

TEST_F(AnimationSampler, RigidNodesMoveAndTurnWithTheirParents) {
  GltfModel model = testing::square_on_node();
  model.document["nodes"] = {{{"name", "carrier"}, {"children", {1}}},
                             {{"name", "square"}, {"mesh", 0}, {"translation", {2, 0, 0}}}};
  turn_about_z(model, 0, 2, 3);
  model.animate(1, "scale", {0, 1}, {1, 1, 1, 3, 1, 1});
  const Mesh mesh = read(model);
  const MeshAnimation& animation = *mesh.animation;
  for (double t_s = 0; t_s < 2; t_s += 0.0173)
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Eigen::Vector3d rest = mesh.vertices[i] - Eigen::Vector3d(2, 0, 0);
      const Eigen::Vector3d scaled(2 + rest.x() * (1 + 2 * std::min(t_s, 1.0)), rest.y(), 0);
      const Eigen::Vector3d expected =
          Eigen::AngleAxisd(2 * t_s, Eigen::Vector3d::UnitZ()) * scaled;
      ASSERT_LT((vertex_at(animation, t_s, i) - expected).norm(), 1.01 * kChordError * 1.5) << t_s;
    }
}

TEST_F(AnimationSampler, StraightMotionsTakeNoMorePosesThanKeys) {
  GltfModel model = testing::square_on_node();
  model.animate(0, "translation", {0, 1, 3}, {0, 0, 0, 1, 0, 0, 1, 4, 0});
  const Mesh mesh = read(model);
  EXPECT_EQ(mesh.animation->times_s, (std::vector<double>{0, 1, 3}));
}

TEST_F(AnimationSampler, SteppedKeysJump) {
  GltfModel model = testing::square_on_node();
  model.animate(0, "translation", {0, 0.5, 1}, {0, 0, 0, 1, 0, 0, 1, 0, 0}, "STEP");
  const Mesh mesh = read(model);
  EXPECT_EQ(vertex_at(*mesh.animation, 0.4999, 0), mesh.vertices[0]);
  EXPECT_EQ(vertex_at(*mesh.animation, 0.5, 0), mesh.vertices[0] + Eigen::Vector3d::UnitX());
}

TEST_F(AnimationSampler, NormalsTurnWithTheirBones) {
  GltfModel model = testing::strip_on_bones();
  model.document["animations"].clear();
  model.animate(2, "rotation", {0, 1}, {0, 0, 0, 1, 0, std::sqrt(0.5F), 0, std::sqrt(0.5F)});
  const Mesh mesh = read(model);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f expected = mesh.vertices[i].x() > 1.1 ? Eigen::Vector3f(1, 0, 0)
                                     : mesh.vertices[i].x() < 0.9
                                         ? Eigen::Vector3f(0, 0, 1)
                                         : mesh.animation->normals.back()[i];
    EXPECT_LT((mesh.animation->normals.back()[i] - expected).norm(), 1e-5F);
  }
}

// As bones that are bound where the file's origin is.
TEST_F(AnimationSampler, SkinsNeedNotStateWhereTheyAreBound) {
  GltfModel model = testing::strip_on_bones();
  model.document["skins"][0].erase("inverseBindMatrices");
  const Mesh mesh = read(model);
  double right = 0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) right = std::max(right, vertex.x());
  EXPECT_NEAR(right, 3, 1e-6);
}

TEST_F(AnimationSampler, UnknownNamesAreErrorsThatListTheKnownOnes) {
  GltfModel model = testing::strip_on_bones();
  EXPECT_THAT(error_of(model, "mave"),
              AllOf(HasSubstr("model.gltf"), HasSubstr("'mave'"), HasSubstr("did you mean 'move'"),
                    HasSubstr("0 'move'")));
  EXPECT_EQ(read(model, "0").animation->name, "move");
  EXPECT_THAT(error_of(model, "1"), HasSubstr("0 'move'"));
  model.document.erase("animations");
  EXPECT_THAT(error_of(model), HasSubstr("holds no animation"));
}

TEST_F(AnimationSampler, AnimationsThatMoveNothingAreErrors) {
  GltfModel model = testing::square_on_node();
  model.animate(0, "translation", {0}, {1, 0, 0});
  EXPECT_THAT(error_of(model), AllOf(HasSubstr("'move'"), HasSubstr("lasts 0 s")));

  model = testing::square_on_node();
  model.document["animations"] = {{{"name", "empty"}}};
  EXPECT_THAT(error_of(model), AllOf(HasSubstr("'empty'"), HasSubstr("no channel")));

  model = testing::square_on_node();
  model.document["scenes"][0]["nodes"] = {0, 1};
  model.document["nodes"].push_back({{"name", "elsewhere"}});
  model.animate(1, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  EXPECT_THAT(error_of(model), HasSubstr("moves nothing that is visible"));
}

TEST_F(AnimationSampler, ChannelsThatAreWrongAreErrors) {
  GltfModel model = testing::square_on_node();
  model.animate(0, "translation", {0, 1}, {0, 0, 0});
  EXPECT_THAT(error_of(model), HasSubstr("keys are not finite values at increasing times"));

  model = testing::square_on_node();
  model.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  model.document["animations"][0]["channels"][0]["sampler"] = 7;
  EXPECT_THAT(error_of(model), HasSubstr("has the sampler 7, of 1"));
  model.document["animations"][0]["channels"][0] = {{"sampler", 0}};
  EXPECT_THAT(error_of(model), HasSubstr("animations cannot be read"));
}

TEST_F(AnimationSampler, WeightsAreScaledToSumToOne) {
  const Mesh right = read(testing::strip_on_bones());
  GltfModel model = testing::strip_on_bones();
  std::vector<float> weights;
  for (int k = 0; k < 9; ++k)
    for (int side = 0; side < 2; ++side) {
      const float second = k < 4 ? 0.0F : k > 4 ? 1.0F : 0.5F;
      weights.insert(weights.end(), {0.5F * (1 - second), 0.5F * second, 0, 0});
    }
  model.document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      model.floats(weights, "VEC4", 4);
  MeshImporter importer;
  const Mesh mesh = importer.read(write("scaled.gltf", model.text()), "");
  EXPECT_EQ(mesh.animation->vertices, right.animation->vertices);
  EXPECT_THAT(importer.remarks().lines(), ::testing::Contains(HasSubstr("do not sum to one")));
}

/// A triangle on a bone, in memory.
Model triangle_on_bone() {
  Model model;
  model.tree = {{"root", -1}, {"bone", 0}};
  ModelPart part;
  part.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  part.triangles = {{0, 1, 2}};
  part.bones.push_back(
      {"bone", 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, {0, 1, 2}, {1, 1, 1}});
  model.parts = {part};
  model.instances.emplace_back();
  model.animations = {
      {"lift", 1, {{1, {KeyInterpolation::kLinear, {0, 1}, {0, 0, 0, 0, 0, 1}}, {}, {}}}}};
  return model;
}

TEST(ModelOnBones, BonesThatAreWrongAreErrorsThatNameThem) {
  const auto error_with = [](const auto& change) {
    Model model = triangle_on_bone();
    change(model.parts[0].bones[0]);
    return testing::error_of(
        [&] { static_cast<void>(sample_animation(model, model.animations[0], "x.fbx")); });
  };
  EXPECT_EQ(sample_animation(triangle_on_bone(), triangle_on_bone().animations[0], "x.fbx")
                .vertices.back()[1],
            Eigen::Vector3f(1, 0, 1));
  EXPECT_THAT(error_with([](ModelBone& bone) { bone.node = -1; }),
              AllOf(HasSubstr("x.fbx"), HasSubstr("bone 'bone' is no node")));
  EXPECT_THAT(error_with([](ModelBone& bone) { bone.weights[1] = -1; }),
              HasSubstr("vertex 1 has the weight -1 of its bone 'bone'"));
  EXPECT_THAT(error_with([](ModelBone& bone) { bone.bone_from_part[12] = INFINITY; }),
              HasSubstr("not finite"));
}

TEST(ModelOnBones, VerticesWithoutWeightsMoveWithTheirInstance) {
  Model model = triangle_on_bone();
  model.parts[0].bones[0].weights[2] = 0;
  const MeshAnimation animation = sample_animation(model, model.animations[0], "x.fbx");
  EXPECT_EQ(animation.vertices.back()[2], Eigen::Vector3f(0, 1, 0));
  EXPECT_FALSE(animation.has_scaled_weights);
}

TEST(ModelOnBones, SurviveTheWayFromAnotherProcess) {
  const Model model = model_from_bytes(to_bytes(triangle_on_bone()));
  const MeshAnimation animation = sample_animation(model, model.animations[0], "x.fbx");
  EXPECT_EQ(animation.vertices.back()[1], Eigen::Vector3f(1, 0, 1));
  EXPECT_EQ(animation.name, "lift");
}

}  // namespace
}  // namespace saccade
