#include "simulator/sensor/event_labels.h"

#include <gtest/gtest.h>

#include <array>

#include "simulator/sensor/image_renderer.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;

/// Events all over the sensor and the recording, in order of time.
SensedEvents events_of(const PinholeCamera& camera, double duration_s, int count) {
  SensedEvents events;
  for (int i = 0; i < count; ++i) {
    SensedEvent event;
    event.t_ns = ns_from_seconds(duration_s * i / count);
    event.x = static_cast<std::uint16_t>(7 * i % camera.width);
    event.y = static_cast<std::uint16_t>(5 * i % camera.height);
    event.origin = static_cast<EventOrigin>(i % 4);
    events.push_back(event);
  }
  return events;
}

Spline straight(const ClosedFormPlane& plane) {
  const Eigen::Vector2d end = plane.start + plane.duration_s * plane.velocity;
  const std::array<StampedPose, 2> poses{
      StampedPose{0, {so3_exp({0, 0, 0}), {plane.start.x(), plane.start.y(), 0}}},
      StampedPose{plane.duration_s, {so3_exp({0, 0, 0}), {end.x(), end.y(), 0}}}};
  return Spline::interpolate(poses);
}

TEST(EventLabels, AgreeWithThePlane) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(61, 46);
  const PinholeCamera camera{61, 46, 100, 100, 30, 22.5, {}};
  const Scene scene = testing::scene_of(plane);
  const Spline motion = straight(plane);
  const SensedEvents events = events_of(camera, plane.duration_s, 1003);  // no multiple of 16
  const EventLabels labels = EventLabeller(scene, motion, camera).label(events);
  ASSERT_EQ(labels.size(), events.size());
  const Eigen::Vector2d flow = -100 / plane.distance_m * plane.velocity;
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_NEAR(labels.depth[i], plane.distance_m, 1e-6);
    EXPECT_NEAR(labels.flow_x[i], flow.x(), 1e-4);
    EXPECT_NEAR(labels.flow_y[i], flow.y(), 1e-4);
    EXPECT_EQ(labels.object[i], 0);
    EXPECT_EQ(labels.origin[i], i % 4);
  }
}

TEST(EventLabels, AgreeWithTheImagesOfADistortingCamera) {
  const PinholeCamera camera{61, 46, 100, 100, 30, 22.5, {-0.2, 0.05, 1e-3, -1e-3, 0}};
  // The left half shows an object, the right half the background.
  const Scene scene = testing::scene_of(
      {testing::rectangle({-9, -9, 4}, {9, 0, 0}, {0, 18, 0}, ImageF(2, 2, 1.0F))});
  const std::array<StampedPose, 2> poses{
      StampedPose{0, {so3_exp({0, 0, 0}), {0, 0, 0}}},
      StampedPose{1, {so3_exp({0.1, 0.05, -0.2}), {0.2, 0.3, 1}}}};
  const Spline motion = Spline::interpolate(poses);
  const ImageRenderer renderer(scene, camera, 1);
  const ImageF depth = renderer.depth({0.5, motion.pose(0.5)});
  const FlowField flow = renderer.flow(motion.state(0.5), 0.5);
  SensedEvents events;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      SensedEvent event;
      event.t_ns = 500'000'000;
      event.x = static_cast<std::uint16_t>(x);
      event.y = static_cast<std::uint16_t>(y);
      events.push_back(event);
    }
  const EventLabels labels = EventLabeller(scene, motion, camera).label(events);
  int hits = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(labels.depth[i], depth.pixels()[i]);
    EXPECT_NEAR(labels.flow_x[i], flow.u.pixels()[i], 1e-4);
    EXPECT_NEAR(labels.flow_y[i], flow.v.pixels()[i], 1e-4);
    EXPECT_EQ(labels.object[i], depth.pixels()[i] > 0 ? 0 : -1);
    hits += labels.object[i] == 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(hits, 61 * 46 - 500);
}

}  // namespace
}  // namespace saccade
