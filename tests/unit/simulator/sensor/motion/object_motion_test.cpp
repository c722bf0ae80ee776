#include "simulator/sensor/motion/object_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "simulator/scene/moving_object.h"
#include "simulator/sensor/event_labels.h"
#include "simulator/sensor/image_renderer.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kLensCamera{41, 30, 60, 63, 21, 14, {-0.2, 0.05, 0.003, -0.002, 0}};

Spline wobble(const Eigen::Vector3d& position, double turn, double shift, double phase) {
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 40; ++k) {
    const double t = 0.025 * k;
    const double a = 7 * t + phase;
    poses.push_back(
        {t,
         {so3_exp(turn * Eigen::Vector3d(std::sin(a), std::cos(1.3 * a), std::sin(0.7 * a))),
          position + shift * Eigen::Vector3d(std::cos(a), std::sin(1.1 * a), std::sin(0.9 * a))}});
  }
  return Spline::interpolate(poses);
}

ImageF waves() {
  ImageF image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      image(x, y) = static_cast<float>(0.5 + 0.2 * std::sin(0.4 * x) + 0.2 * std::cos(0.3 * y));
  return image;
}

Mesh textured_plane() {
  return testing::rectangle({-0.8, -0.6, 0}, {1.6, 0, 0.1}, {0, 1.2, 0}, waves());
}

/// The state of the inverse motion: R^T, -R^T t.
SplineState inverted(const SplineState& state) {
  const Eigen::Quaterniond back = state.world_from_body.rotation().conjugate();
  const Rigid3 inverse = state.world_from_body.inverse();
  SplineState result;
  result.world_from_body = inverse;
  result.angular_velocity_in_body =
      -(state.world_from_body.rotation() * state.angular_velocity_in_body);
  result.velocity_in_world =
      state.angular_velocity_in_body.cross(-inverse.translation()) - back * state.velocity_in_world;
  return result;
}

void expect_equal(const ImageF& a, const ImageF& b, double tolerance) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(
        largest, std::abs(static_cast<double>(a.pixels()[i]) - static_cast<double>(b.pixels()[i])));
  EXPECT_LE(largest, tolerance);
}

TEST(MovingView, PlaneBeforeACameraAtRestEqualsTheOppositeMotion) {
  const Spline motion = wobble({0.1, -0.1, 2}, 0.3, 0.25, 0);
  SceneBuilder still, moving;
  still.add(textured_plane(), Eigen::Affine3d::Identity());
  moving.add_moving(textured_plane(), Eigen::Affine3d::Identity(), motion);
  const Scene still_scene = std::move(still).build(Background(0.5));
  const Scene moving_scene = std::move(moving).build(Background(0.5));
  const ImageRenderer still_view(still_scene, kLensCamera, 4);
  const ImageRenderer moving_view(moving_scene, kLensCamera, 4);
  for (const double t : {0.03, 0.31, 0.66, 0.97}) {
    const SplineState state = inverted(motion.state(t));
    const StampedPose pose{t, state.world_from_body};
    expect_equal(moving_view.radiance(std::vector<StampedPose>{{t, {}}}),
                 still_view.radiance(std::vector<StampedPose>{pose}), 1e-6);
    expect_equal(moving_view.depth({t, {}}), still_view.depth(pose), 1e-6);
    SplineState rest;
    rest.velocity_in_world.setZero();
    rest.angular_velocity_in_body.setZero();
    const FlowField moved = moving_view.flow(rest, t);
    const FlowField expected = still_view.flow(state, t);
    const ImageF depth = still_view.depth(pose);
    int compared = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (depth.pixels()[i] <= 0) {
        EXPECT_EQ(moved.u.pixels()[i], 0);
        continue;
      }
      ++compared;
      const float size = 1 + std::hypot(expected.u.pixels()[i], expected.v.pixels()[i]);
      EXPECT_NEAR(moved.u.pixels()[i], expected.u.pixels()[i], 1e-6F * size);
      EXPECT_NEAR(moved.v.pixels()[i], expected.v.pixels()[i], 1e-6F * size);
    }
    EXPECT_GT(compared, 300);
    EXPECT_LT(compared, 41 * 30);
  }
}

TEST(MovingView, FlowIsTheMotionOfTheSeenPointWhenBothMove) {
  const Spline object = wobble({0, 0, 2}, 0.3, 0.2, 0);
  const Spline motion = wobble({0, 0, 0}, 0.2, 0.3, 2);
  SceneBuilder builder;
  builder.add_moving(textured_plane(), Eigen::Affine3d::Identity(), object);
  const Scene scene = std::move(builder).build(Background(0.5));
  const ImageRenderer view(scene, kLensCamera, 1);
  constexpr double kTime_s = 0.43;
  constexpr double kStep_s = 1e-4;
  const FlowField flow = view.flow(motion.state(kTime_s), kTime_s);
  const ImageF depth = view.depth({kTime_s, motion.pose(kTime_s)});
  int compared = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 41; ++x) {
      if (depth(x, y) <= 0) continue;
      ++compared;
      const Eigen::Vector3d ray = kLensCamera.ray(kLensCamera.undistort({x, y}));
      const Eigen::Vector3d on_object =
          object.pose(kTime_s).inverse() *
          (motion.pose(kTime_s) * (static_cast<double>(depth(x, y)) * ray));
      const auto pixel_at = [&](double t) {
        return kLensCamera.distort(
            kLensCamera.project(motion.pose(t).inverse() * (object.pose(t) * on_object)));
      };
      const Eigen::Vector2d expected =
          (pixel_at(kTime_s + kStep_s) - pixel_at(kTime_s - kStep_s)) / (2 * kStep_s);
      EXPECT_NEAR(flow.u(x, y), expected.x(), 1e-4 * (1 + expected.norm()));
      EXPECT_NEAR(flow.v(x, y), expected.y(), 1e-4 * (1 + expected.norm()));
    }
  EXPECT_GT(compared, 200);
}

TEST(MovingView, LabelsOfEventsAgreeWithTheImages) {
  SceneBuilder builder;
  builder.add_moving(textured_plane(), Eigen::Affine3d::Identity(), wobble({0, 0, 2}, 0.3, 0.2, 0));
  const Scene scene = std::move(builder).build(Background(0.5));
  const Spline motion = wobble({0, 0, 0}, 0.2, 0.3, 2);
  constexpr double kTime_s = 0.43;
  const ImageRenderer view(scene, kLensCamera, 1);
  const ImageF depth = view.depth({kTime_s, motion.pose(kTime_s)});
  const FlowField flow = view.flow(motion.state(kTime_s), kTime_s);
  SensedEvents events;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 41; ++x) {
      SensedEvent event;
      event.t_ns = ns_from_seconds(kTime_s);
      event.x = static_cast<std::uint16_t>(x);
      event.y = static_cast<std::uint16_t>(y);
      events.push_back(event);
    }
  const EventLabels labels = EventLabeller(scene, motion, kLensCamera).label(events);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(labels.object[i], depth.pixels()[i] > 0 ? 0 : -1);
    EXPECT_NEAR(labels.depth[i], depth.pixels()[i], 1e-6);
    EXPECT_NEAR(labels.flow_x[i], flow.u.pixels()[i], 1e-3);
    EXPECT_NEAR(labels.flow_y[i], flow.v.pixels()[i], 1e-3);
  }
}

TEST(ObjectMotion, BoundHoldsForEveryPointThatPassesThere) {
  const PinholeCamera camera{120, 90, 100, 105, 59.5, 44.5, {}};
  constexpr double kRadius_px = 2.83;
  constexpr double kSpan_s = 0.01;
  const Random random(11);
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.uniform(0, draw++);
  };
  double tightest = 0;
  int passed = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SceneBuilder builder;
    builder.add_moving(textured_plane(), Eigen::Affine3d::Identity(),
                       wobble({uniform(-1, 1), uniform(-1, 1), 2.5}, 0.5, 0.5, uniform(0, 6)));
    const Scene scene = std::move(builder).build(Background(0.5));
    const MovingObject& object = scene.moving_objects()[0];
    const Spline motion = wobble({0, 0, 0}, 0.2, 0.4, uniform(0, 6));
    const double from_s = uniform(0, 0.98);
    const ObjectMotion bounds(scene, motion, from_s, from_s + kSpan_s);
    for (int k = 0; k < 500; ++k) {
      const double t = from_s + uniform(0, kSpan_s);
      const Eigen::Vector3d on_object(uniform(-0.8, 0.8), uniform(-0.6, 0.6), 0);
      const Eigen::Vector3d point =
          motion.pose(t).inverse() *
          (object.pose(t) *
           Eigen::Vector3d(on_object.x(), on_object.y(), 0.1 * (on_object.x() + 0.8) / 1.6));
      if (point.z() < 0.1) continue;
      const Eigen::Vector2d pixel = camera.project(point);
      const double angle = uniform(0, 6.28);
      const Eigen::Vector2d centre =
          pixel + uniform(0, kRadius_px) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Twist twist = relative_twist(motion.state(t), object.state(t));
      const double speed =
          (interaction_matrix(camera, point / point.z(), point.z()) * twist).norm();
      const double bound = bounds.bound(camera, camera.ray(centre), kRadius_px, {}).fastest;
      ASSERT_LE(speed, 1.05 * bound);
      tightest = std::max(tightest, speed / bound);
      ++passed;
    }
  }
  EXPECT_GT(passed, 5000);
  EXPECT_GT(tightest, 0.8);
}

TEST(ObjectMotion, NothingElsewhereNorBehindWhatIsSeen) {
  const PinholeCamera camera{120, 90, 100, 105, 59.5, 44.5, {}};
  SceneBuilder builder;
  builder.add_moving(textured_plane(), Eigen::Affine3d::Identity(), wobble({0, 0, 3}, 0.1, 0.1, 0));
  const Scene scene = std::move(builder).build(Background(0.5));
  const Spline motion = wobble({0, 0, 0}, 0, 0, 0);
  const ObjectMotion bounds(scene, motion, 0.2, 0.21);
  const Eigen::Vector3d centre = camera.ray({60, 45});
  const Eigen::Vector3d aside = camera.ray({110, 45});
  EXPECT_GT(bounds.bound(camera, centre, 3, {}).fastest, 1);
  EXPECT_GT(bounds.bound(camera, centre, 3, {}).parallax, 1);
  EXPECT_EQ(bounds.bound(camera, aside, 3, {}).fastest, 0);
  EXPECT_EQ(bounds.bound(camera, centre, 3, {0.5, 0.6}).fastest, 0) << "a wall before it";
  SceneBuilder other;
  other.add(textured_plane(), Eigen::Affine3d::Identity());
  const Scene still = std::move(other).build(Background(0.5));
  EXPECT_EQ(ObjectMotion(still, motion, 0, 0.01).bound(camera, centre, 3, {}).fastest, 0);
}

}  // namespace
}  // namespace saccade
