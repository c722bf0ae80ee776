// Events of highlights, which move with the camera.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/process/parallel.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/event_camera.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

const PinholeCamera kGlossCamera{20, 12, 200, 200, 0.5, 4.5, {}};
constexpr double kGlossDuration_s = 0.05;

LightOptions lamp_beside() {
  LightOptions light;
  light.position = {0.3, -0.2, 0};
  light.intensity = 12;
  return light;
}

Mesh glossy(Mesh mesh, double roughness) {
  for (Material& material : mesh.materials) material.gloss = make_gloss(0.2, roughness);
  return mesh;
}

/// A wall, plain or textured, with a ball that has smooth normals, and a card that casts a shadow.
Scene glossy_scene(double roughness, bool is_textured, bool has_objects, bool moves = false) {
  SceneBuilder builder;
  Mesh wall = testing::slanted_wall();
  if (!is_textured)
    for (Material& material : wall.materials) material.texture = nullptr;
  builder.add(glossy(wall, roughness), Eigen::Affine3d::Identity());
  if (has_objects) {
    builder.add(
        glossy(testing::ball({0.2, 0.1, 2.2}, 0.1, 16, testing::patches(128, 64, 4)), roughness),
        Eigen::Affine3d::Identity());
    const Mesh card = glossy(testing::rectangle({0.02, -0.05, 1.6}, {0.05, 0, 0}, {0, 0.05, 0},
                                                testing::patches(32, 32, 5)),
                             roughness);
    if (moves)
      builder.add_moving(card, Eigen::Affine3d::Identity(),
                         testing::lively_motion(kGlossDuration_s, 1, 0.5, 7));
    else
      builder.add(card, Eigen::Affine3d::Identity());
  }
  builder.light(0.1, {lamp_beside()});
  return std::move(builder).build(Background(0.5));
}

TEST(GlossEvents, ExactEventsAgreeWithBruteForce) {
  struct Case {
    double roughness;
    bool is_textured, has_objects, moves;
    int samples;
  };
  for (const Case& c : {Case{0.3, false, false, false, 1}, Case{0.1, true, false, false, 1},
                        Case{0.25, true, true, false, 1}, Case{0.4, true, true, true, 1},
                        Case{0.25, true, true, false, 4}}) {
    EventOptions options;
    options.samples_per_pixel = c.samples;
    const testing::Agreement result = testing::agreement(
        glossy_scene(c.roughness, c.is_textured, c.has_objects, c.moves),
        testing::lively_motion(kGlossDuration_s, 1.5, 1, 4), kGlossCamera, options);
    std::printf("roughness %g, texture %d, objects %d, moves %d: %s\n", c.roughness,
                c.is_textured ? 1 : 0, c.has_objects ? 1 : 0, c.moves ? 1 : 0,
                result.text().c_str());
    EXPECT_GT(result.expected, 200U);
    EXPECT_GE(result.share_10_us(), 0.999);
    EXPECT_GE(result.share_1_us(), 0.99);
  }
}

// Without a texture nothing but the light changes: a matt wall under a far lamp hardly fires.
TEST(GlossEvents, AHighlightFiresWhereAMattWallDoesNot) {
  const Spline motion = testing::lively_motion(kGlossDuration_s, 1.5, 1, 4);
  const auto count = [&](bool is_glossy) {
    Mesh wall = testing::slanted_wall();
    for (Material& material : wall.materials) {
      material.texture = nullptr;
      if (is_glossy) material.gloss = make_gloss(0.2, 0.2);
    }
    SceneBuilder builder;
    builder.add(wall, Eigen::Affine3d::Identity());
    builder.light(0.1, {lamp_beside()});
    const Scene scene = std::move(builder).build(Background(0.5));
    return testing::record(scene, motion, kGlossCamera, {}).events.size();
  };
  EXPECT_GT(count(true), 20 * count(false) + 100);
}

/// Bounds of what is mirrored over short intervals of a camera's motion hold at all times in them,
/// and those of its rate for differences; but for what the directions to eye and light leave their
/// lines.
TEST(GlossEvents, BoundsOfWhatIsMirroredContainWhatRaysSee) {
  constexpr double kInterval_s = 5e-4;
  constexpr int kParts = 16;
  constexpr double kOffLine = 1e-4;  // of the highlight's greatest radiance
  const Spline motion = testing::lively_motion(kGlossDuration_s, 1.5, 1, 4);
  for (const double roughness : {0.1, 0.2, 0.5}) {
    const Scene scene = glossy_scene(roughness, true, false);
    double greatest = 0;
    for (const bool is_checked : {false, true})
      for (int n = 0; n < 3000; ++n) {
        const double from_s = (kGlossDuration_s - kInterval_s) * (n % 97) / 97;
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
        if (!is_checked) {
          greatest = std::max(greatest, seen_at(from_s).mirrored);
          continue;
        }
        const auto range = scene.light_range(first, seen_at(from_s), ray_at(0.5 * (from_s + to_s)),
                                             ray_at(to_s), seen_at(to_s), triangle, 1);
        ASSERT_TRUE(range);
        double last = 0;
        for (int k = 0; k <= kParts; ++k) {
          const double value = seen_at(from_s + kInterval_s * k / kParts).mirrored;
          ASSERT_LE(range->mirrored.low, value + kOffLine * greatest) << n;
          ASSERT_GE(range->mirrored.high, value - kOffLine * greatest) << n;
          const double rate = (value - last) * kParts / kInterval_s;
          if (k > 0) {
            ASSERT_LE(range->mirrored.rate_low, rate + kOffLine * greatest / kInterval_s) << n;
            ASSERT_GE(range->mirrored.rate_high, rate - kOffLine * greatest / kInterval_s) << n;
          }
          last = value;
        }
      }
    EXPECT_GT(greatest, 0.1) << roughness;
  }
}

template <class Camera>
Events glossy_events(const Scene& scene, const Spline& motion, const EventOptions& options) {
  Camera sensor(scene, motion, kGlossCamera, options);
  Events all;
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> events, double) {
    for (const SensedEvent& event : events) all.push_back(event.event());
  });
  return all;
}

TEST(GlossEvents, AdaptiveAgreesWithExact) {
  const Spline motion = testing::lively_motion(kGlossDuration_s, 1.5, 1, 4);
  for (const double roughness : {0.1, 0.3})
    for (const bool has_objects : {false, true}) {
      const Scene scene = glossy_scene(roughness, true, has_objects);
      const EventOptions options = testing::in_nanoseconds();
      const Events exact = glossy_events<EventCamera>(scene, motion, options);
      const Events sampled = glossy_events<AdaptiveCamera>(scene, motion, options);
      const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 10'000));
      const double least = pairs / static_cast<double>(std::max(exact.size(), sampled.size()));
      std::printf("roughness %g, objects %d: %zu exact and %zu adaptive events, %.4f in pairs\n",
                  roughness, has_objects ? 1 : 0, exact.size(), sampled.size(), least);
      EXPECT_GT(least, 0.985);
    }
}

/// A small plain plate, in whose place a plate stays while it turns by a radian: lamps flash through
/// its pixels, although its image hardly moves.
Scene turning_plate(double roughness, double ambient) {
  Mesh plate = testing::rectangle({-0.2, -0.2, 0}, {0.4, 0, 0}, {0, 0.4, 0}, ImageF(2, 2, 0.5F));
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 10; ++k)
    poses.push_back({0.02 * k, Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(
                                          0.1 * k - 0.5, Eigen::Vector3d::UnitY())),
                                      Eigen::Vector3d(0, 0, 2))});
  SceneBuilder builder;
  builder.add_moving(glossy(plate, roughness), Eigen::Affine3d::Identity(),
                     Spline::interpolate(poses));
  builder.light(ambient, {lamp_beside()});
  return std::move(builder).build(Background(0.5));
}

TEST(GlossEvents, AdaptiveSeesTheFlashesOfAPlateThatTurns) {
  std::vector<StampedPose> poses;
  for (int k = 0; k <= 4; ++k) poses.push_back({0.05 * k, Rigid3()});
  const Spline still = Spline::interpolate(poses);
  for (const double roughness : {0.1, 0.2})
    for (const double ambient : {0.1, 5.0, 30.0}) {
      const Scene scene = turning_plate(roughness, ambient);
      const EventOptions options = testing::in_nanoseconds();
      const Events exact = glossy_events<EventCamera>(scene, still, options);
      const Events sampled = glossy_events<AdaptiveCamera>(scene, still, options);
      const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 10'000));
      const double least = pairs / static_cast<double>(std::max(exact.size(), sampled.size()));
      std::printf("roughness %g, ambient %g: %zu exact and %zu adaptive events, %.4f in pairs\n",
                  roughness, ambient, exact.size(), sampled.size(), least);
      EXPECT_GT(exact.size(), 100U);
      EXPECT_EQ(sampled.size(), exact.size());
      // Next to a signal's extremum a crossing takes longer than that.
      EXPECT_GT(least, 0.97);
    }
}

class GlossThreads : public ::testing::Test {
 protected:
  ~GlossThreads() override { set_thread_count(0); }
};

TEST_F(GlossThreads, DoNotChangeTheStream) {
  const Scene scene = glossy_scene(0.2, true, true, true);
  const Spline motion = testing::lively_motion(0.02, 1.5, 1, 4);
  set_thread_count(1);
  const Events exact = glossy_events<EventCamera>(scene, motion, {});
  const Events sampled = glossy_events<AdaptiveCamera>(scene, motion, {});
  EXPECT_GT(exact.size(), 100U);
  set_thread_count(3);
  EXPECT_EQ(glossy_events<EventCamera>(scene, motion, {}), exact);
  EXPECT_EQ(glossy_events<AdaptiveCamera>(scene, motion, {}), sampled);
}

}  // namespace
}  // namespace saccade
