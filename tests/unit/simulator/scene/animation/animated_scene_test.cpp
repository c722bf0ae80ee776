#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "simulator/scene/animation/animation_sampler.h"
#include "simulator/scene/moving_object.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/image_renderer.h"
#include "simulator/sensor/labels/label_renderer.h"
#include "simulator/sensor/labels/optical_flow_renderer.h"
#include "tests/unit/simulator/scene/animation/animated_scenes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using std::numbers::pi;
using testing::GltfModel;

class AnimatedScene : public testing::AnimatedFiles {};

Ray down_on(double x, double y, double t_s) { return {{x, y, 2}, -Eigen::Vector3d::UnitZ(), t_s}; }

Eigen::Vector3d turned(const Eigen::Vector3d& point, double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * point;
}

TEST_F(AnimatedScene, ASkinIsWhereItsBonesTakeItAtEveryTime) {
  const Scene scene = this->scene(testing::strip_on_bones());
  EXPECT_TRUE(scene.is_animated());
  const Eigen::Vector3d pivot(1, 0, 0);
  int seen = 0;
  for (double t_s = 0; t_s < 1; t_s += 0.0371)
    for (double r = 0.3; r < 1; r += 0.09)
      for (const double off : {-0.3, -0.1, 0.0, 0.2}) {
        const double angle = pi * t_s + off / r;  // along the arc
        const Eigen::Vector3d at = pivot + r * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        const Eigen::Vector3d rest = turned(at - pivot, -pi * t_s) + pivot;
        if (rest.x() < 1.26 || rest.x() > 1.99 || at.x() < 1) continue;  // the still part is there
        const Ray ray = down_on(at.x(), at.y(), t_s);
        const TriangleId triangle = testing::look(scene, ray);
        if (std::abs(rest.y()) > 0.249) continue;
        ASSERT_NE(triangle, kNothing) << at.transpose() << " " << t_s;
        ++seen;
        const SurfaceSample sample = scene.sample_surface(ray, triangle);
        EXPECT_NEAR(sample.distance, 2, 1e-6);
        EXPECT_NEAR(sample.x, (rest.x() + 1) / 4, 5e-5);
        EXPECT_GE(scene.min_barycentric(ray, triangle), -1e-6);
        EXPECT_LT((scene.normal(ray, triangle) - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
        const Eigen::Vector3d later = pivot + turned(at - pivot, pi * 0.3);
        if (t_s < 0.7) {
          EXPECT_LT((scene.carried_point(ray, triangle, t_s + 0.3) - later).norm(), 2e-4);
        }
        const Eigen::Vector3d velocity = pi * Eigen::Vector3d::UnitZ().cross(at - pivot);
        // A chord of the least length has this error, and its end twice that.
        EXPECT_LT((scene.deformation_velocity(ray, triangle, t_s) - velocity).norm(),
                  0.012 * velocity.norm());
      }
  EXPECT_GT(seen, 200);
  // And where it is not any more.
  EXPECT_EQ(testing::look(scene, down_on(1.8, 0, 0.5)), kNothing);
  EXPECT_NE(testing::look(scene, down_on(1.8, 0, 0)), kNothing);
}

TEST_F(AnimatedScene, ManyPosesAreManyPiecesForEmbree) {
  GltfModel model = testing::square_on_node();
  turn_about_z(model, 0, pi, 9);
  const Scene scene = this->scene(model);
  ASSERT_GT(scene.moving_objects()[0].animation()->step_count(), 600U);
  // Rays of one packet in different pieces.
  std::vector<Ray> rays;
  for (int k = 0; k < 16; ++k) {
    const double t_s = 0.29 * k;
    const Eigen::Vector3d at = turned({0.6, 0.3, 0}, pi * t_s);
    rays.push_back(down_on(at.x(), at.y(), t_s));
  }
  std::array<TriangleId, 16> triangles;
  scene.visible(rays, triangles);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    ASSERT_NE(triangles[k], kNothing) << k;
    EXPECT_NEAR(scene.sample_surface(rays[k], triangles[k]).x, 0.2 + 0.4 * 0.6, 1e-4) << k;
  }
}

TEST_F(AnimatedScene, NormalsTurnWithTheSurface) {
  GltfModel model = testing::square_on_node();
  const float half = std::sqrt(0.5F);
  model.animate(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, half, 0, half});  // about y, to -z
  const Scene scene = this->scene(model);
  for (double t_s = 0; t_s < 0.8; t_s += 0.0137) {
    const double angle = 0.5 * pi * t_s;
    const double x = 0.5 * std::cos(angle);
    const Ray ray = down_on(x, 0.4, t_s);
    const TriangleId triangle = testing::look(scene, ray);
    ASSERT_NE(triangle, kNothing);
    EXPECT_NEAR(scene.sample_surface(ray, triangle).distance, 2 + x * std::tan(angle), 1e-4);
    const Eigen::Vector3d expected(std::sin(angle), 0, std::cos(angle));
    EXPECT_LT((scene.normal(ray, triangle) - expected).norm(), 1e-4) << t_s;
  }
}

TEST_F(AnimatedScene, OnATrajectoryAMeshMovesAndDeforms) {
  const Scene scene = this->scene(
      testing::turning_square(true),
      "animation: {start_s: 0.1, speed: 0.5}, trajectory: {source: slider, from: [0, 0, 0], "
      "direction: [1, 0, 0], distance_m: 1, duration_s: 1}");
  const double t_s = 0.5;
  const Eigen::Vector3d at = Eigen::Vector3d(t_s, 0, 0) + turned({0.3, 0.1, 0}, 0.5 * pi * 0.4);
  const Ray ray = down_on(at.x(), at.y(), t_s);
  const TriangleId triangle = testing::look(scene, ray);
  ASSERT_NE(triangle, kNothing);
  EXPECT_NEAR(scene.sample_surface(ray, triangle).x, 0.2 + 0.4 * 0.8, 5e-5);
  const Eigen::Vector3d later = Eigen::Vector3d(0.8, 0, 0) + turned({0.3, 0.1, 0}, 0.5 * pi * 0.7);
  EXPECT_LT((scene.carried_point(ray, triangle, 0.8) - later).norm(), 1e-4);
}

TEST_F(AnimatedScene, FlowIsThatOfTheDeformation) {
  const Scene scene = this->scene(testing::turning_square(true));
  const PinholeCamera camera{80, 60, 60, 60, 39.5, 29.5, {}};
  const Spline motion = testing::resting_above({0, 0}, 1);
  const ImageRenderer renderer(scene, camera, 1);
  const double t_s = 0.4567;
  const FlowField field = renderer.flow(motion.state(t_s), t_s);
  const OpticalFlow flow = OpticalFlowRenderer(scene, camera)
                               .flow({t_s, motion.pose(t_s)}, {t_s + 0.1, motion.pose(t_s + 0.1)});
  const ImageF depth = renderer.depth({t_s, motion.pose(t_s)});
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      // 30 px/m; y of the image is -y of the world.
      const Eigen::Vector2d from_axis(x - 39.5, y - 29.5);
      if (from_axis.norm() > 0.49 * 30) continue;
      ASSERT_NEAR(depth(x, y), 2, 1e-5);
      const Eigen::Vector2d velocity = pi * Eigen::Vector2d(from_axis.y(), -from_axis.x());
      const Eigen::Vector2d measured(field.u(x, y), field.v(x, y));
      EXPECT_LT((measured - velocity).norm(), 0.012 * velocity.norm() + 1e-4) << x << " " << y;
      const Eigen::Vector2d to = Eigen::Rotation2Dd(-0.1 * pi) * from_axis;
      EXPECT_LT((Eigen::Vector2d(flow.u(x, y), flow.v(x, y)) - (to - from_axis)).norm(), 3e-3);
      EXPECT_EQ(flow.covisibility(x, y), static_cast<std::uint8_t>(Covisibility::kVisible));
    }
  EXPECT_EQ(field.u(0, 0), 0);  // the background before a camera at rest
}

TEST_F(AnimatedScene, LabelsFollowTheSurface) {
  const Scene scene = this->scene(testing::strip_on_bones(), "animation: {}, class: limb");
  const PinholeCamera camera{80, 60, 40, 40, 39.5, 29.5, {}};
  const LabelRenderer labels(scene, camera);
  const Rigid3 pose = testing::from_above({1, 0});
  // 20 px/m: at half a second the moving half stands upwards.
  const InstanceMask lying = labels.mask({0, pose});
  const InstanceMask standing = labels.mask({0.5, pose});
  EXPECT_EQ(lying.classes(55, 30), 1);
  EXPECT_EQ(standing.classes(55, 30), 0);
  EXPECT_EQ(lying.classes(40, 15), 0);
  EXPECT_EQ(standing.classes(40, 15), 1);
}

TEST_F(AnimatedScene, LightAndShadowFollowTheSurface) {
  GltfModel model = testing::square_on_node();
  const float half = std::sqrt(0.5F);
  model.animate(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, half, 0, half});
  const Scene scene = this->scene(
      model, "animation: {}",
      "lighting: lambertian\nlights: [{type: directional, direction: [0, 0, -1], intensity: 1}]\n");
  for (const double t_s : {0.0, 0.2, 0.5}) {
    const double angle = 0.5 * pi * t_s;
    const double x = 0.5 * std::cos(angle);
    EXPECT_NEAR(testing::see(scene, down_on(x, 0.4, t_s)).radiance, 0.4 * std::cos(angle), 2e-4);
  }
}

TEST_F(AnimatedScene, TrianglesThatStartInOnePlaceAndPartAreBothKept) {
  GltfModel model = testing::square_on_node();
  model.document["scenes"][0]["nodes"] = {0, 1};
  model.document["nodes"].push_back({{"name", "twin"}, {"mesh", 0}});
  model.animate(1, "translation", {0, 1}, {0, 0, 0, 2, 0, 0});
  EXPECT_EQ(scene(model).triangle_count(), 4U);
  // Both alike: from either side the same.
  model.animate(0, "translation", {0, 1}, {0, 0, 0, 2, 0, 0});
  EXPECT_EQ(scene(model).triangle_count(), 2U);
}

TEST_F(AnimatedScene, ASquareThatGrowsFromAPointIsThere) {
  GltfModel model = testing::square_on_node();
  model.animate(0, "scale", {0, 1}, {0, 0, 0, 1, 1, 1});
  const Scene scene = this->scene(model);
  EXPECT_EQ(testing::look(scene, down_on(0.4, 0.4, 0.3)), kNothing);
  EXPECT_NE(testing::look(scene, down_on(0.4, 0.4, 0.5)), kNothing);
}

TEST_F(AnimatedScene, StillMeshesOfTheSameFileStayStill) {
  write("model.gltf", testing::turning_square(false).text());
  const Scene scene = build_scene(config::read<SceneOptions>(config::parse(
      "meshes:\n  - {file: model.gltf, up: z}\n"
      "  - {file: model.gltf, up: z, animation: {}, transform: {translation: [3, 0, 0]}}\n",
      "scene.yaml", folder_)));
  EXPECT_EQ(scene.triangle_count(), 4U);
  EXPECT_EQ(scene.moving_objects().size(), 1U);
  EXPECT_NEAR(testing::see(scene, down_on(0.3, 0, 0.5)).radiance, 0.2 + 0.4 * 0.8, 1e-6);
  EXPECT_NEAR(testing::see(scene, down_on(3.3, 0, 0.5)).radiance, 0.2 + 0.4 * 0.5, 1e-4);
}

}  // namespace
}  // namespace saccade
