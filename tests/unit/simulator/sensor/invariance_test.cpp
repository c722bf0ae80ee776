// The stream depends on the scene and the motion alone: not on how densely the signal is sampled,
// by how many threads, or with how many interruptions.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/process/parallel.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

constexpr double kStretch_s = 0.06;
const PinholeCamera kSmallCamera{22, 14, 200, 200, 10, 7, {}};

Mesh card(std::uint64_t seed) {
  return testing::rectangle({-0.2, -0.2, 1.4}, {0.3, 0.05, 0}, {-0.05, 0.3, 0.1},
                            testing::patches(64, 64, seed));
}

Scene still_scene() { return testing::scene_of({testing::slanted_wall(), card(2)}); }

/// A card that moves and one that does not, under a light.
Scene lively_scene() {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  builder.add(card(2), Eigen::Affine3d::Identity());
  builder.add_moving(card(3), Eigen::Affine3d::Identity(),
                     testing::lively_motion(kStretch_s, 2, 1, 7));
  LightOptions lamp;
  lamp.position = {0.5, -1, 0};
  lamp.intensity = 4;
  builder.light(0.3, {lamp});
  return std::move(builder).build(Background(0.5));
}

Spline motion() { return testing::lively_motion(kStretch_s, 1.5, 1, 4); }

EventOptions ideal() {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  return options;
}

EventOptions with_all_noise(int rays_per_pixel, double cutoff_hz) {
  EventOptions options = ideal();
  options.samples_per_pixel = rays_per_pixel;
  options.noise.mismatch.sigma = 0.05;
  options.noise.refractory.period_us = 300;
  options.noise.leak = {5, 0.2};
  options.noise.shot.rate_hz = 20;
  options.noise.bandwidth.cutoff_hz = cutoff_hz;
  options.noise.hot = {0.02, 500, 0.5};
  options.noise.latency = {30, 5};
  options.noise.readout.rate_hz = 1e6;
  return options;
}

/// Everything that is known of the events, as the sink receives them.
SensedEvents sense(EventCamera& camera, double end_s) {
  SensedEvents all;
  camera.record(end_s, [&](std::span<const SensedEvent> some, double) {
    all.insert(all.end(), some.begin(), some.end());
  });
  return all;
}

// 0.137 divides neither the slices nor the other steps.
TEST(Invariance, DenserSamplingGivesTheSameEvents) {
  const Scene scene = still_scene();
  const Spline way = motion();
  EventOptions options = ideal();
  const Events normal = testing::record(scene, way, kSmallCamera, options).events;
  ASSERT_GT(normal.size(), 2000U);
  for (const double step_px : {0.137, 0.05}) {
    options.max_step_px = step_px;
    const Events dense = testing::record(scene, way, kSmallCamera, options).events;
    EXPECT_EQ(dense.size(), normal.size()) << step_px;
    EXPECT_EQ(testing::count_pairs(dense, normal, 1000), normal.size()) << step_px;
  }
}

class EventCameraThreadsAndNoise : public ::testing::TestWithParam<int> {
 protected:
  ~EventCameraThreadsAndNoise() override { set_thread_count(0); }
};

TEST_P(EventCameraThreadsAndNoise, DoNotChangeTheStream) {
  const Scene scene = lively_scene();
  const Spline way = motion();
  for (const double cutoff_hz : {0.0, 200.0}) {
    const EventOptions options = with_all_noise(GetParam(), cutoff_hz);
    set_thread_count(1);
    EventCamera alone(scene, way, kSmallCamera, options, 5);
    const SensedEvents expected = sense(alone, way.end_s());
    EXPECT_GT(expected.size(), 200U);
    for (const int threads : {2, 8}) {
      set_thread_count(threads);
      EventCamera camera(scene, way, kSmallCamera, options, 5);
      EXPECT_EQ(sense(camera, way.end_s()), expected) << threads;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(RaysPerPixel, EventCameraThreadsAndNoise, ::testing::Values(1, 4));

/// Records again from every saved state.
void expect_same_after_resuming(const EventOptions& options) {
  const Scene scene = lively_scene();
  const Spline way = motion();
  struct Saved {
    std::string state;
    std::size_t events;
  };
  std::vector<Saved> saved;
  SensedEvents expected;
  EventCamera first(scene, way, kSmallCamera, options, 9);
  first.record(way.end_s(), [&](std::span<const SensedEvent> some, double t_s) {
    expected.insert(expected.end(), some.begin(), some.end());
    if (t_s < way.end_s()) saved.push_back({first.state(), expected.size()});
  });
  ASSERT_GT(saved.size(), 2U);
  for (std::size_t k = 0; k < saved.size(); k += 3) {
    EventCamera second(scene, way, kSmallCamera, options, 9);
    second.resume(saved[k].state);
    const SensedEvents rest = sense(second, way.end_s());
    ASSERT_EQ(saved[k].events + rest.size(), expected.size()) << k;
    EXPECT_TRUE(std::equal(rest.begin(), rest.end(),
                           expected.begin() + static_cast<std::ptrdiff_t>(saved[k].events)))
        << k;
    EXPECT_EQ(second.statistics().rays, first.statistics().rays);
    EXPECT_EQ(second.statistics().surface_samples, first.statistics().surface_samples);
  }
}

TEST(EventCameraState, IdealCameraGoesOnWhereItWas) {
  EventOptions options = ideal();
  expect_same_after_resuming(options);
  options.samples_per_pixel = 4;
  expect_same_after_resuming(options);
}

TEST(EventCameraState, NoisyCameraGoesOnWhereItWas) {
  expect_same_after_resuming(with_all_noise(1, 0));
  expect_same_after_resuming(with_all_noise(1, 200));
}

TEST(Reconstruction, StaysWithinTheThresholdAtAllTimes) {
  const Spline way = motion();
  const Scene flat = testing::scene_of({testing::slanted_wall()});
  const Scene cards = still_scene();
  const EventOptions options = ideal();
  for (const Scene* scene : {&flat, &cards}) {
    const Events events = testing::record(*scene, way, kSmallCamera, options).events;
    EXPECT_LE(testing::reconstruction_excess(*scene, way, kSmallCamera, options, events, 2e-5,
                                             1e-6 * options.time_tolerance_us),
              1e-9);
  }
}

}  // namespace
}  // namespace saccade
