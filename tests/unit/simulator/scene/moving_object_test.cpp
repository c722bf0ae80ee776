#include "simulator/scene/moving_object.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/random.h"
#include "simulator/scene/build_scene.h"
#include "simulator/scene/scene_builder.h"
#include "tests/unit/simulator/scene/mesh_files.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::see;

const Eigen::Vector3d kDown = -Eigen::Vector3d::UnitZ();

/// Turns about x, y and z while it moves.
Spline tumbling(const Eigen::Vector3d& around = Eigen::Vector3d::Zero()) {
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 50; ++k) {
    const double t = 0.02 * k;
    poses.push_back({t,
                     {so3_exp({0.4 * std::sin(9 * t), 0.3 * std::cos(7 * t), 2 * t}),
                      around + Eigen::Vector3d(std::sin(5 * t), 0.4 * std::cos(8 * t), 0.3 * t)}});
  }
  return Spline::interpolate(poses);
}

/// Along x from -1 to 1 within a second.
Spline sliding(double height_m) {
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  return Spline::interpolate(std::vector<StampedPose>{{0, {upright, {-1, 0, height_m}}},
                                                      {1, {upright, {1, 0, height_m}}}});
}

/// [-half, half]^2 at z = 0, white.
Mesh white_square(double half) {
  return testing::rectangle({-half, half, 0}, {2 * half, 0, 0}, {0, -2 * half, 0}, ImageF(2, 2, 1));
}

LightOptions sun_from_above() {
  LightOptions sun;
  sun.type = LightType::kDirectional;
  sun.direction = kDown;
  return sun;
}

TEST(MovingObject, IsWhereItsSplineIsAndRestsBeyondItsEnds) {
  const Spline motion = tumbling();
  const MovingObject object(3, motion, {Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 0)});
  EXPECT_NEAR(object.radius(), std::sqrt(2), 1e-15);
  for (int k = -100; k <= 1100; ++k) {
    const double t = 1e-3 * k;
    const Rigid3 pose = motion.pose(t);
    const CameraFrame frame = object.frame(t);
    ASSERT_LT((frame.rotation - pose.rotation_matrix()).cwiseAbs().maxCoeff(), 3e-9) << t;
    ASSERT_LT((frame.position - pose.translation()).cwiseAbs().maxCoeff(), 3e-9) << t;
  }
  EXPECT_GT(object.state(0.999).velocity_in_world.norm(), 0.5);
  EXPECT_EQ(object.state(1.001).velocity_in_world.norm(), 0);
  EXPECT_EQ(object.state(-0.001).angular_velocity_in_body.norm(), 0);
}

TEST(MovingScene, RaysSeeObjectsAtTheirOwnTimes) {
  SceneBuilder builder;
  builder.add(white_square(3), Eigen::Affine3d::Identity());
  builder.add_moving(white_square(0.5), Eigen::Affine3d::Identity(), sliding(1));
  const Scene scene = std::move(builder).build(Background(0));
  ASSERT_EQ(scene.moving_objects().size(), 1U);
  EXPECT_EQ(scene.moving_objects()[0].object(), 1U);
  for (int k = 0; k <= 15; ++k) {
    const double t = k / 15.0;
    const double offset_m = -1 + 2 * t;
    EXPECT_NEAR(see(scene, {{0, 0, 5}, kDown, t}).distance, std::abs(offset_m) < 0.5 ? 4 : 5, 1e-9)
        << t;
    const Ray at_border{{offset_m + 0.4999, 0.2, 5}, kDown, t};
    const Ray beyond{{offset_m + 0.5001, 0.2, 5}, kDown, t};
    EXPECT_NEAR(see(scene, at_border).distance, 4, 1e-9) << t;
    EXPECT_NEAR(see(scene, beyond).distance, 5, 1e-9) << t;
  }
}

TEST(MovingScene, MixedPacketsAgreeWithSingleRays) {
  SceneBuilder builder;
  builder.add(white_square(2), Eigen::Affine3d::Identity());
  for (int k = 0; k < 3; ++k)
    builder.add_moving(white_square(0.7), Eigen::Affine3d::Identity(), tumbling({0, 0, 1.0 + k}));
  const Scene scene = std::move(builder).build(Background(0));
  const Random random(3);
  std::array<int, 4> seen{};
  for (std::uint64_t packet = 0; packet < 1000; ++packet) {
    std::array<Ray, 16> rays;
    std::array<TriangleId, 16> triangles;
    for (std::uint64_t i = 0; i < 16; ++i) {
      const auto draw = [&](std::uint64_t k) { return random.uniform(packet, 8 * i + k); };
      rays[i] = {{4 * draw(0) - 2, 4 * draw(1) - 2, 8},
                 {draw(2) - 0.5, draw(3) - 0.5, -2},
                 i < 8 ? 0.4 : draw(4)};
    }
    scene.visible(rays, triangles);
    for (std::size_t i = 0; i < 16; ++i) {
      TriangleId alone = 0;
      scene.visible({&rays[i], 1}, {&alone, 1});
      EXPECT_EQ(triangles[i], alone);
      EXPECT_TRUE(alone == kNothing || scene.intersects(rays[i], alone));
      if (alone == kNothing) continue;
      EXPECT_EQ(scene.moving_object(alone) == nullptr, scene.object(alone) == 0);
      ++seen[scene.object(alone)];
    }
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(MovingScene, ShadowsFallFromAndOntoMovingObjects) {
  SceneBuilder builder;
  builder.add(white_square(3), Eigen::Affine3d::Identity());
  builder.add_moving(white_square(0.25), Eigen::Affine3d::Identity(), sliding(1));
  builder.add(white_square(0.125), Eigen::Affine3d(Eigen::Translation3d(0, 0, 2)));
  builder.light(0.25, {sun_from_above()});
  const Scene scene = std::move(builder).build(Background(0));
  constexpr double kLit = 1.25;
  constexpr double kDark = 0.25;
  const auto floor_at = [&](double x, double t) {
    return see(scene, {{x, 0, 0.5}, kDown, t}).radiance;
  };
  EXPECT_NEAR(floor_at(0.24, 0.5), kDark, 1e-12);
  EXPECT_NEAR(floor_at(0.26, 0.5), kLit, 1e-12);
  EXPECT_NEAR(floor_at(0.24, 0.8), kLit, 1e-12) << "it has moved on to x = 0.6";
  EXPECT_NEAR(floor_at(0.6, 0.8), kDark, 1e-12);
  EXPECT_NEAR(floor_at(0.1, 0.8), kDark, 1e-12) << "the static one's shadow stays";
  const auto object_at = [&](double x, double t) {
    return see(scene, {{x, 0, 1.5}, kDown, t}).radiance;
  };
  EXPECT_NEAR(object_at(0.12, 0.5), kDark, 1e-12);
  EXPECT_NEAR(object_at(0.13, 0.5), kLit, 1e-12);
  EXPECT_NEAR(object_at(0.12, 0.6), kDark, 1e-12) << "the shadow runs over the object";
  EXPECT_NEAR(object_at(0.13, 0.6), kLit, 1e-12);
}

TEST(MovingScene, NoMovingSurfaceShadesItself) {
  SceneBuilder builder;
  builder.add_moving(white_square(1), Eigen::Affine3d::Identity(), tumbling({40, -30, 20}));
  builder.light(0, {sun_from_above()});
  const Scene scene = std::move(builder).build(Background(0));
  for (int k = 0; k <= 1000; ++k) {
    const double t = 1e-3 * k;
    const CameraFrame frame = scene.moving_objects()[0].frame(t);
    const Eigen::Vector3d point =
        frame.rotation * Eigen::Vector3d(0.9 * std::sin(0.3 * k), 0.9 * std::cos(0.7 * k), 0) +
        frame.position;
    const Shade shade = see(scene, {point - 2 * kDown, kDown, t});
    ASSERT_NEAR(shade.distance, 2, 1e-9);
    ASSERT_NEAR(shade.radiance, frame.rotation.col(2).z(), 1e-6) << "the cosine";
  }
}

TEST(MovingScene, CutoutsMoveAlong) {
  Mesh screen = white_square(0.5);
  ImageF holes(2, 1, 1.0F);
  holes(0, 0) = 0;  // its half with x < 0
  screen.materials[0].opacity = std::make_shared<Texture>(holes, Wrap::kClamp, Wrap::kClamp);
  SceneBuilder builder;
  builder.add_moving(screen, Eigen::Affine3d::Identity(), sliding(1));
  builder.add(white_square(3), Eigen::Affine3d::Identity());
  builder.light(0, {sun_from_above()});
  const Scene scene = std::move(builder).build(Background(0));
  EXPECT_NEAR(see(scene, {{0.2, 0, 5}, kDown, 0.5}).distance, 4, 1e-9);
  EXPECT_NEAR(see(scene, {{-0.2, 0, 5}, kDown, 0.5}).distance, 5, 1e-9);
  EXPECT_NEAR(see(scene, {{0.2, 0, 5}, kDown, 0.65}).distance, 5, 1e-9);
  EXPECT_NEAR(see(scene, {{0.2, 0, 0.5}, kDown, 0.5}).radiance, 0, 1e-12);
  EXPECT_NEAR(see(scene, {{0.2, 0, 0.5}, kDown, 0.65}).radiance, 1, 1e-12);
}

class MovingSceneFile : public testing::MeshFiles {
 protected:
  SceneOptions options(const std::string& yaml) const {
    return config::read<SceneOptions>(config::parse(yaml, "scene.yaml", folder_));
  }
  std::string error_of(const std::string& mesh_keys) const {
    try {
      static_cast<void>(build_scene(options("meshes: [{file: square.obj, " + mesh_keys + "}]")));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(MovingSceneFile, TrajectoryComesAfterTheTransform) {
  write("square.obj", testing::square_obj());
  const SceneOptions read = options(
      "meshes:\n"
      "  - file: square.obj\n"
      "    transform: {translation: [0, 0, 1], scale: 0.5}\n"
      "    trajectory: {source: slider, duration_s: 2, from: [4, 0, 2], direction: [0, 1, 0], "
      "distance_m: 6, rotation_deg: [0, 0, 90]}\n"
      "  - {file: square.obj}\n");
  EXPECT_EQ(config::print(options(config::print(read))), config::print(read));
  const Scene scene = build_scene(read);
  ASSERT_EQ(scene.moving_objects().size(), 1U);
  EXPECT_EQ(scene.moving_objects()[0].object(), 0U);
  // The half-size square turned by 90 degrees about its corner: x in [3.5, 4], y in [3, 3.5] at 1
  // s.
  EXPECT_NEAR(see(scene, {{3.51, 3.01, 9}, kDown, 1}).distance, 6, 1e-8);
  EXPECT_NEAR(see(scene, {{3.99, 3.49, 9}, kDown, 1}).distance, 6, 1e-8);
  EXPECT_EQ(see(scene, {{4.01, 3.01, 9}, kDown, 1}).distance, 0);
  EXPECT_NEAR(see(scene, {{3.51, 6.01, 9}, kDown, 7}).distance, 6, 1e-8) << "at rest after its end";
}

TEST_F(MovingSceneFile, MalformedTrajectoriesAreErrorsWithTheirPlace) {
  write("square.obj", testing::square_obj());
  EXPECT_THAT(error_of("trajectory: {source: circles}"),
              AllOf(HasSubstr("scene.yaml:1"), HasSubstr("circle")));
  EXPECT_THAT(error_of("trajectory: {source: circle, radius: 1}"),
              AllOf(HasSubstr("meshes[0].trajectory"), HasSubstr("radius_m")));
  EXPECT_THAT(error_of("trajectory: {from: [0, 0, 0]}"), HasSubstr("source"));
  EXPECT_THAT(error_of("trajectory: {source: file, file: nowhere.txt}"), HasSubstr("nowhere.txt"));
  EXPECT_THAT(error_of("trajectory: {source: waypoints, waypoints: [[0, 0, 0, 0, 0, 0, 0, 1], [0, "
                       "1, 0, 0, 0, 0, 0, 1]]}"),
              AllOf(HasSubstr("waypoints"), HasSubstr("increase")));
}

}  // namespace
}  // namespace saccade
