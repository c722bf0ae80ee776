// Irradiance, events and frames under spots.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/process/parallel.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kSpotCamera{20, 12, 200, 200, 0.5, 4.5, {}};
constexpr double kSpotDuration_s = 0.05;

LightOptions spot(double inner_deg, double outer_deg) {
  LightOptions light;
  light.type = LightType::kSpot;
  light.position = {0.3, -0.2, 0};
  light.direction = {0.14, 0.06, 1};  // its edge, at 10 degrees, is seen on the wall
  light.intensity = 12;
  light.inner_angle_deg = inner_deg;
  light.outer_angle_deg = outer_deg;
  return light;
}

/// A wall under lights, with a ball and a card before it that cast shadows.
Scene scene_under(const std::vector<LightOptions>& lights, bool moves = false,
                  bool has_objects = true) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  if (has_objects)
    builder.add(testing::ball({0.2, 0.1, 2.2}, 0.1, 16, testing::patches(128, 64, 4)),
                Eigen::Affine3d::Identity());
  const Mesh card = testing::rectangle({0.02, -0.05, 1.6}, {0.05, 0, 0}, {0, 0.05, 0},
                                       testing::patches(32, 32, 5));
  if (moves)
    builder.add_moving(card, Eigen::Affine3d::Identity(),
                       testing::lively_motion(kSpotDuration_s, 1, 0.5, 7));
  else if (has_objects)
    builder.add(card, Eigen::Affine3d::Identity());
  builder.light(0.05, lights);
  return std::move(builder).build(Background(0.5));
}

TEST(SpotLight, IrradianceIsTheClosedFormAtAnyAngle) {
  SceneBuilder builder;
  builder.add(testing::rectangle({-10, -10, 2}, {20, 0, 0}, {0, 20, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  LightOptions light = spot(20, 40);
  light.position = {0, 0, 0.5};
  light.direction = {0, 0, 7};
  builder.light(0.125, {light});
  const Scene scene = std::move(builder).build(Background(0));
  const auto cosine = [](double deg) { return std::cos(deg * std::numbers::pi / 180); };
  for (const double angle : {0.0, 10.0, 19.9, 20.1, 25.0, 30.0, 39.0, 41.0, 70.0}) {
    const double across = 1.5 * std::tan(angle * std::numbers::pi / 180);
    const double part =
        std::clamp((cosine(angle) - cosine(40)) / (cosine(20) - cosine(40)), 0.0, 1.0);
    const double expected =
        0.125 + part * part * 12 * cosine(angle) / (1.5 * 1.5 + across * across);
    const Ray ray{{0, 0, 0}, {0.6 * across, 0.8 * across, 2}};
    EXPECT_NEAR(testing::see(scene, ray).radiance, expected, 1e-6) << angle;
  }
}

TEST(SpotLight, LightsNothingThroughOccluders) {
  // Where the line from the light through the ball's centre meets the wall.
  const Eigen::Vector3d position(0.3, -0.2, 0), centre(0.2, 0.1, 2.2);
  const Eigen::Vector3d shaded = position + 2.049 * (centre - position);
  const Ray ray{shaded - Eigen::Vector3d(1, 0, 1), {1, 0, 1}};
  LightOptions light = spot(40, 45);
  const auto irradiance_in = [&](const Scene& scene) {
    const TriangleId triangle = testing::look(scene, ray);
    return scene.shade(ray, triangle).radiance / scene.sample_surface(ray, triangle).radiance();
  };
  EXPECT_NEAR(irradiance_in(scene_under({light})), 0.05, 1e-9);
  light.shadows = false;
  EXPECT_GT(irradiance_in(scene_under({light})), 0.5);
  light.outer_angle_deg = 5;
  light.inner_angle_deg = 4;
  EXPECT_NEAR(irradiance_in(scene_under({light})), 0.05, 1e-9) << "outside the cone";
}

/// Bounds of the irradiance over short intervals of a camera's motion hold at all times in them,
/// and those of its rate hold for differences; but for what a point light's irradiance leaves its
/// line near an extremum.
TEST(SpotLight, BoundsOfTheIrradianceContainWhatRaysSee) {
  constexpr double kInterval_s = 5e-4;
  constexpr int kParts = 16;
  constexpr double kOffLine = 1e-5;
  const Spline motion = testing::lively_motion(kSpotDuration_s, 1.5, 1, 4);
  for (const auto& [inner, outer] : {std::pair{5.0, 20.0}, {11.0, 12.0}, {12.0, 12.05}}) {
    const Scene scene = scene_under({spot(inner, outer)}, false, false);
    int tight = 0, all = 0;
    for (int n = 0; n < 3000; ++n) {
      const double from_s = (kSpotDuration_s - kInterval_s) * (n % 97) / 97;
      const Eigen::Vector3d direction((n % 53) / 53.0 - 0.5, (n % 31) / 31.0 - 0.5, 1);
      const auto ray_at = [&](double t_s) -> Ray {
        const Rigid3 pose = motion.pose(t_s);
        return {pose.translation(), pose.rotation_matrix() * direction, t_s};
      };
      const Ray first = ray_at(from_s);
      const TriangleId triangle = testing::look(scene, first);
      const auto seen_at = [&](double t_s) {
        const Ray ray = ray_at(t_s);
        SurfaceSample seen = scene.sample_surface(ray, triangle);
        seen.lights = 1;
        scene.set_light(ray, triangle, seen);
        return seen;
      };
      const double to_s = from_s + kInterval_s;
      const auto range = scene.light_range(first, seen_at(from_s), ray_at(0.5 * (from_s + to_s)),
                                           ray_at(to_s), seen_at(to_s), triangle, 1);
      ASSERT_TRUE(range);
      double last = 0;
      for (int k = 0; k <= kParts; ++k) {
        const double value = seen_at(from_s + kInterval_s * k / kParts).irradiance;
        ASSERT_LE(range->irradiance.low, value + kOffLine) << n;
        ASSERT_GE(range->irradiance.high, value - kOffLine) << n;
        const double rate = (value - last) * kParts / kInterval_s;
        if (k > 0) {
          ASSERT_LE(range->irradiance.rate_low, rate + kOffLine / kInterval_s) << n;
          ASSERT_GE(range->irradiance.rate_high, rate - kOffLine / kInterval_s) << n;
        }
        last = value;
      }
      ++all;
      if (range->irradiance.rate_low >= -1e-6 || range->irradiance.rate_high <= 1e-6) ++tight;
    }
    std::printf("%g to %g degrees: %d of %d intervals are monotone for certain\n", inner, outer,
                tight, all);
    EXPECT_GT(tight, all / 2);
  }
}

TEST(SpotLight, ExactEventsAgreeWithBruteForce) {
  struct Case {
    double inner, outer;
    bool moves;
    int samples;
  };
  for (const Case& c : {Case{4, 14, false, 1}, Case{9, 10, false, 4}, Case{9, 10, true, 1},
                        Case{10, 10.2, false, 1}}) {
    EventOptions options;
    options.samples_per_pixel = c.samples;
    const testing::Agreement result = testing::agreement(
        scene_under({spot(c.inner, c.outer)}, c.moves),
        testing::lively_motion(kSpotDuration_s, 1.5, 1, 4), kSpotCamera, options);
    std::printf("%g to %g degrees, moves %d: %s\n", c.inner, c.outer, c.moves ? 1 : 0,
                result.text().c_str());
    EXPECT_GT(result.expected, 1000U);
    EXPECT_GE(result.share_10_us(), 0.999);
    EXPECT_GE(result.share_1_us(), 0.99);
  }
}

// Beams a third of a pixel wide pass between two samples of a pixel, which see nothing of them: only
// the bounds of the falloff tell of them.
TEST(SpotLight, BeamsThinnerThanAPixelPassUnseenNowhere) {
  std::vector<LightOptions> beams;
  for (int k = 0; k < 24; ++k) {
    LightOptions beam = spot(0.02, 0.05);
    beam.direction = {-0.06 + 0.016 * (k % 6), 0.02 + 0.017 * std::floor(k / 6), 1};
    beams.push_back(beam);
  }
  const testing::Agreement result =
      testing::agreement(scene_under(beams, false, false),
                         testing::lively_motion(kSpotDuration_s, 1.5, 1, 4), kSpotCamera, {});
  std::printf("%s\n", result.text().c_str());
  EXPECT_GT(result.expected, 1000U);
  EXPECT_GE(result.share_10_us(), 0.999);
  EXPECT_GE(result.share_1_us(), 0.99);
}

template <class Camera>
Events events_of(const Scene& scene, const Spline& motion, const EventOptions& options) {
  Camera sensor(scene, motion, kSpotCamera, options);
  Events all;
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> events, double) {
    for (const SensedEvent& event : events) all.push_back(event.event());
  });
  return all;
}

TEST(SpotLight, AdaptiveAgreesWithExact) {
  const Spline motion = testing::lively_motion(kSpotDuration_s, 1.5, 1, 4);
  for (const auto& [inner, outer] : {std::pair{4.0, 14.0}, {9.0, 10.0}, {10.0, 10.2}})
    for (const bool moves : {false, true}) {
      const Scene scene = scene_under({spot(inner, outer)}, moves);
      const EventOptions options = testing::in_nanoseconds();
      const Events exact = events_of<EventCamera>(scene, motion, options);
      const Events sampled = events_of<AdaptiveCamera>(scene, motion, options);
      const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 10'000));
      const double least = pairs / static_cast<double>(std::max(exact.size(), sampled.size()));
      std::printf("%g to %g degrees: %zu exact and %zu adaptive events, %.4f in pairs\n", inner,
                  outer, exact.size(), sampled.size(), least);
      EXPECT_GT(least, 0.985);
    }
}

TEST(SpotLight, SeveralConesAndALampAddUp) {
  LightOptions lamp;
  lamp.position = {-1, -1, 0};
  LightOptions second = spot(3, 8);
  second.position = {-0.4, 0.3, 0.5};
  second.flicker = FlickerOptions{100, Waveform::kSine, 0.5, 0.5, 0};
  const testing::Agreement result =
      testing::agreement(scene_under({spot(9, 12), lamp, second}),
                         testing::lively_motion(kSpotDuration_s, 1.5, 1, 9), kSpotCamera, {});
  std::printf("%s\n", result.text().c_str());
  EXPECT_GT(result.expected, 1000U);
  EXPECT_GE(result.share_10_us(), 0.999);
  EXPECT_GE(result.share_1_us(), 0.99);
}

class SpotLightThreads : public ::testing::Test {
 protected:
  ~SpotLightThreads() override { set_thread_count(0); }
};

TEST_F(SpotLightThreads, DoNotChangeTheStream) {
  const Scene scene = scene_under({spot(9, 10)}, true);
  const Spline motion = testing::lively_motion(0.02, 1.5, 1, 4);
  set_thread_count(1);
  const Events exact = events_of<EventCamera>(scene, motion, {});
  const Events sampled = events_of<AdaptiveCamera>(scene, motion, {});
  EXPECT_GT(exact.size(), 100U);
  set_thread_count(3);
  EXPECT_EQ(events_of<EventCamera>(scene, motion, {}), exact);
  EXPECT_EQ(events_of<AdaptiveCamera>(scene, motion, {}), sampled);
}

}  // namespace
}  // namespace saccade
