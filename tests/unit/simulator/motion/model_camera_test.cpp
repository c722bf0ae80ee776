#include "simulator/motion/model_camera.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/config/config.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/describe_mesh.h"
#include "simulator/simulation_config.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/animation/gltf_models.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using testing::GltfModel;
using ::testing::HasSubstr;

/// Two cameras: one at (2, 0, 0) on an arm that turns about z, one that rests at (0, 1, 5). Both
/// look along -z with y upwards.
GltfModel film_set() {
  GltfModel model = testing::square_on_node();
  model.document["scenes"][0]["nodes"] = {0, 1, 3};
  auto& nodes = model.document["nodes"];
  nodes.push_back({{"name", "arm"}, {"children", {2}}});
  nodes.push_back({{"name", "crane"}, {"translation", {2, 0, 0}}, {"camera", 0}});
  nodes.push_back({{"name", "tripod"}, {"translation", {0, 1, 5}}, {"camera", 0}});
  model.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", pi / 3}, {"znear", 0.1}}}}};
  turn_about_z(model, 1, 0.5 * pi, 3);
  return model;
}

class ModelCamera : public testing::MeshFiles {
 protected:
  Spline motion(const GltfModel& model, const std::string& keys) const {
    write("set.gltf", model.text());
    return build_motion(config::read<MotionOptions>(
        config::parse("{source: model_camera, model: set.gltf, " + keys + "}", "a.yaml", folder_)));
  }
  std::string error_of(const GltfModel& model, const std::string& keys) const {
    return testing::error_of([&] { static_cast<void>(motion(model, keys)); });
  }
};

/// Axes of a camera that looks along -z with y upwards.
Eigen::Matrix3d downwards() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }

TEST_F(ModelCamera, AnAnimatedOneFollowsItsArm) {
  const Spline path = motion(film_set(), "camera: crane, model_up: z");
  EXPECT_EQ(path.start_s(), 0);
  EXPECT_NEAR(path.end_s(), 3, 1e-6);
  for (double t_s = 0; t_s <= 3; t_s += 0.0371) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.5 * pi * t_s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const SplineState state = path.state(t_s);
    const Eigen::Vector3d expected = turn * Eigen::Vector3d(2, 0, 0);
    EXPECT_LT((state.world_from_body.translation() - expected).norm(), 5e-5) << t_s;
    EXPECT_LT((state.world_from_body.rotation_matrix() - turn * downwards()).norm(), 5e-5) << t_s;
    const Eigen::Vector3d velocity = 0.5 * pi * Eigen::Vector3d::UnitZ().cross(expected);
    if (t_s > 0.1 && t_s < 2.9) {
      EXPECT_LT((state.velocity_in_world - velocity).norm(), 1e-4);
    }
  }
}

TEST_F(ModelCamera, StandsUprightWithItsMesh) {
  // y of the file is z of the world, where the camera looks along +y.
  const Rigid3 pose = motion(film_set(), "camera: tripod, model_up: y, duration_s: 2").pose(1);
  EXPECT_LT((pose.translation() - Eigen::Vector3d(0, -5, 1)).norm(), 1e-9);
  EXPECT_LT((pose.rotation() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((pose.rotation() * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

TEST_F(ModelCamera, TakesTheTransformOfEveryTrajectory) {
  const Rigid3 pose =
      motion(film_set(),
             "camera: tripod, model_up: z, transform: {scale: 2, translation: [1, 0, 0]}")
          .pose(0.5);
  EXPECT_LT((pose.translation() - Eigen::Vector3d(1, 2, 10)).norm(), 1e-9);
}

TEST_F(ModelCamera, ItsFieldOfViewMaySetTheFocalLength) {
  write("set.gltf", film_set().text());
  const auto config = [&](const std::string& sets) {
    return config::read<SimulationConfig>(config::parse(
        "scene: {meshes: [{file: set.gltf}]}\ncamera: {width: 320, height: 200, fx: 99}\n"
        "trajectory: {source: model_camera, model: set.gltf, camera: crane, sets_focal_length: " +
            sets + "}\n",
        "a.yaml", folder_));
  };
  EXPECT_NEAR(config("true").camera.fx, 100 / std::tan(pi / 6), 1e-4);
  EXPECT_EQ(config("true").camera.fx, config("true").camera.fy);
  EXPECT_EQ(config("false").camera.fx, 99);
}

TEST_F(ModelCamera, UnknownNamesAreErrorsThatNameTheKnownOnes) {
  EXPECT_THAT(error_of(film_set(), "camera: train"),
              AllOf(HasSubstr("set.gltf"), HasSubstr("'train'"), HasSubstr("crane, tripod")));
  EXPECT_THAT(error_of(film_set(), "model_up: y"),
              AllOf(HasSubstr("2 cameras"), HasSubstr("crane, tripod")));
  EXPECT_THAT(error_of(film_set(), "camera: crane, animation: fly"),
              AllOf(HasSubstr("'fly'"), HasSubstr("0 'move'")));
  EXPECT_THAT(error_of(film_set(), "camera: tripod, animation: move"),
              HasSubstr("does not move the camera"));
  EXPECT_THAT(error_of(testing::square_on_node(), "model_up: y"), HasSubstr("holds no camera"));
}

TEST_F(ModelCamera, OfFlatNodesHaveNoViewDirection) {
  GltfModel model = film_set();
  model.document["nodes"][3]["scale"] = {1, 1, 0};
  EXPECT_THAT(error_of(model, "camera: tripod"), HasSubstr("no view direction"));
}

TEST_F(ModelCamera, AreListedWithTheAnimations) {
  const std::string text = describe_mesh(write("set.gltf", film_set().text()));
  EXPECT_THAT(text, AllOf(HasSubstr("'crane' 60 deg wide"), HasSubstr("'tripod'"),
                          HasSubstr("0 'move' of 3 s moves 1 nodes")));
}

TEST_F(ModelCamera, TheTrajectoryThatIsSuggestedIsOne) {
  const std::string text = describe_mesh(write("set.gltf", film_set().text()));
  const std::size_t begin = text.find("trajectory: {");
  ASSERT_NE(begin, std::string::npos);
  const std::string line = text.substr(begin, text.find('\n', begin) - begin);
  EXPECT_THAT(line, AllOf(HasSubstr("camera: 'crane'"), HasSubstr("animation: 'move'")));
  const Spline path = build_motion(config::read<MotionOptions>(
      config::parse(line.substr(line.find('{')), "suggested.yaml", folder_)));
  EXPECT_NEAR(path.end_s(), 3, 1e-6);
}

}  // namespace
}  // namespace saccade
