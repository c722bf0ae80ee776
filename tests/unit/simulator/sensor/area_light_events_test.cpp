// Events under area lights and the light of the surroundings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <span>

#include "core/process/parallel.h"
#include "simulator/scene/light/environment_light.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kAreaCamera{20, 12, 200, 200, 0.5, 4.5, {}};
constexpr double kAreaDuration_s = 0.05;

/// A wall in the half-shadow of a card, under a sky that is bright on one side.
Scene area_scene(LightType type) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  builder.add(
      testing::rectangle({0.1, -0.3, 2.6}, {0.3, 0, 0}, {0, 0.5, 0}, testing::patches(32, 32, 5)),
      Eigen::Affine3d::Identity());
  LightOptions light;
  light.type = type;
  light.position = {-0.5, -0.6, 0.5};
  light.direction = {0.2, 0.2, 1};
  light.size_m = {0.6, 0.3};
  light.radius_m = 0.3;
  light.intensity = 12;
  builder.light(0.05, {light});
  ImageF sky(16, 8, 0.2F);
  for (int x = 4; x < 8; ++x) sky(x, 1) = 1;
  builder.light_from_around(EnvironmentLight(sky, 0, 1));
  return std::move(builder).build(Background(0.5));
}

template <class Camera>
Events area_events(const Scene& scene, const Spline& motion) {
  EventOptions options = testing::in_nanoseconds();
  options.audit_fraction = 0;
  Camera sensor(scene, motion, kAreaCamera, options);
  Events all;
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> events, double) {
    for (const SensedEvent& event : events) all.push_back(event.event());
  });
  return all;
}

TEST(AreaLightEvents, ExactOnesAreThoseOfBruteForce) {
  const Spline motion = testing::lively_motion(kAreaDuration_s, 2, 1, 5);
  for (const LightType type : {LightType::kRectangle, LightType::kDisc}) {
    const Scene scene = area_scene(type);
    const testing::Agreement agreement =
        testing::agreement(scene, motion, kAreaCamera, testing::in_nanoseconds());
    std::printf("%s\n", agreement.text().c_str());
    EXPECT_GT(agreement.expected, 300U);
    EXPECT_GT(agreement.share_1_us(), 0.995);
  }
}

TEST(AreaLightEvents, AdaptiveOnesAreNearlyTheExactOnesForAnyNumberOfThreads) {
  const Spline motion = testing::lively_motion(kAreaDuration_s, 2, 1, 5);
  const Scene scene = area_scene(LightType::kRectangle);
  set_thread_count(1);
  const Events exact = area_events<EventCamera>(scene, motion);
  const Events sampled = area_events<AdaptiveCamera>(scene, motion);
  const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 10'000));
  const double least = pairs / static_cast<double>(std::max(exact.size(), sampled.size()));
  std::printf("%zu exact and %zu adaptive events, %.4f in pairs\n", exact.size(), sampled.size(),
              least);
  EXPECT_GT(least, 0.97);
  set_thread_count(3);
  EXPECT_EQ(area_events<EventCamera>(scene, motion), exact);
  EXPECT_EQ(area_events<AdaptiveCamera>(scene, motion), sampled);
}

}  // namespace
}  // namespace saccade
