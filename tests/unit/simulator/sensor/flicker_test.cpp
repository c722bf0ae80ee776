// Events and frames under lights that flicker.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/process/parallel.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/frame_camera.h"
#include "simulator/sensor/image_renderer.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

constexpr double kAmbient = 0.1;
constexpr double kIntensity = 0.8;
constexpr double kAlbedo = 0.6;
constexpr double kFlickerDuration_s = 0.0437;
const PinholeCamera kCamera{10, 6, 200, 200, 4.5, 2.5, {}};

Scene even_plane(const FlickerOptions& flicker) {
  SceneBuilder builder;
  builder.add(testing::rectangle({-1, -1, 2}, {2, 0, 0}, {0, 2, 0},
                                 ImageF(2, 2, static_cast<float>(kAlbedo))),
              Eigen::Affine3d::Identity());
  builder.light(kAmbient, {{.type = LightType::kDirectional,
                            .direction = Eigen::Vector3d::UnitZ(),
                            .intensity = kIntensity,
                            .flicker = flicker}});
  return std::move(builder).build(Background(0));
}

Spline at_rest(double duration_s) {
  const std::vector<StampedPose> poses = {{0, Rigid3()}, {duration_s, Rigid3()}};
  return Spline::interpolate(poses);
}

struct Fired {
  double t_s;
  int polarity;
};

/// The log intensity of a pixel before the plane.
double signal(const Flicker& flicker, double log_eps, double t_s) {
  const double albedo = static_cast<double>(static_cast<float>(kAlbedo));
  return std::log(log_eps + albedo * (kAmbient + kIntensity * flicker.at(t_s)));
}

/// The events of such a pixel: between two breaks of the flicker its signal is monotone, so that
/// each crossing is found by bisection of the closed form.
std::vector<Fired> closed_form(const FlickerOptions& options, const EventOptions& events) {
  const Flicker flicker(options);
  const auto value = [&](double t_s) { return signal(flicker, events.log_eps, t_s); };
  std::vector<double> ends;
  flicker.find_breaks(0, kFlickerDuration_s, 1e-10, ends);
  ends.push_back(kFlickerDuration_s);
  std::vector<Fired> fired;
  double reference = value(0), from_s = 0;
  for (const double end_s : ends) {
    while (true) {
      const double change = value(end_s) - reference;
      // A light that is switched returns to its former thresholds exactly, which fires.
      constexpr double kRounding = 1e-9;
      if (change < events.contrast.on - kRounding && change > kRounding - events.contrast.off)
        break;
      const int sign = change > 0 ? 1 : -1;
      reference += sign > 0 ? events.contrast.on : -events.contrast.off;
      double lo = from_s, hi = end_s;
      while (hi - lo > 1e-12) {
        const double middle = 0.5 * (lo + hi);
        (sign * (value(middle) - reference) < 0 ? lo : hi) = middle;
      }
      fired.push_back({hi, sign});
      from_s = hi;
    }
    from_s = end_s;
  }
  return fired;
}

std::vector<FlickerOptions> waveforms() {
  return {{100, Waveform::kSine, 0.7, 0.5, 20},
          {100, Waveform::kMains, 0.9, 0.5, 10},
          {120, Waveform::kMains, 1, 0.5, 77},
          {410, Waveform::kSquare, 0.8, 0.3, 10}};
}

template <class Camera>
SensedEvents record(const Scene& scene, const Spline& motion, const EventOptions& options,
                    const PinholeCamera& camera = kCamera) {
  Camera sensor(scene, motion, camera, options);
  SensedEvents all;
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> events, double) {
    all.insert(all.end(), events.begin(), events.end());
  });
  return all;
}

/// The greatest error of time; every pixel must have fired all of `expected`, in order.
double worst_error_s(const std::vector<Fired>& expected, const SensedEvents& events) {
  double worst = 0;
  for (int y = 0; y < kCamera.height; ++y)
    for (int x = 0; x < kCamera.width; ++x) {
      std::vector<Fired> found;
      for (const SensedEvent& event : events)
        if (event.x == x && event.y == y)
          found.push_back({seconds_from_ns(event.t_ns), event.polarity});
      EXPECT_EQ(found.size(), expected.size()) << x << " " << y;
      if (found.size() != expected.size()) return 1;
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].polarity, expected[k].polarity);
        worst = std::max(worst, std::abs(found[k].t_s - expected[k].t_s));
      }
    }
  return worst;
}

template <class Camera>
void expect_closed_form(double tolerance_s, const EventOptions& events) {
  for (const FlickerOptions& flicker : waveforms()) {
    const std::vector<Fired> expected = closed_form(flicker, events);
    const SensedEvents found =
        record<Camera>(even_plane(flicker), at_rest(kFlickerDuration_s), events);
    const double worst = worst_error_s(expected, found);
    std::printf("%zu events per pixel, worst error %.3f us\n", expected.size(), 1e6 * worst);
    EXPECT_GT(expected.size(), 20U);
    EXPECT_LE(worst, tolerance_s);
  }
}

TEST(FlickeringLight, ExactEventsAreThoseOfTheClosedForm) {
  EventOptions options = testing::in_nanoseconds();
  expect_closed_form<EventCamera>(1.01e-6, options);
  options.samples_per_pixel = 4;
  expect_closed_form<EventCamera>(1.01e-6, options);
}

TEST(FlickeringLight, AdaptiveEventsAreThoseOfTheClosedForm) {
  EventOptions options = testing::in_nanoseconds();
  options.sampling = Sampling::kAdaptive;
  expect_closed_form<AdaptiveCamera>(1e-5, options);
  options.samples_per_pixel = 4;
  expect_closed_form<AdaptiveCamera>(1e-5, options);
}

// By its rule: linear between two frames a sixteenth of a period apart.
TEST(FlickeringLight, FramesFollowTheFlicker) {
  for (const FlickerOptions& flicker : waveforms()) {
    if (flicker.waveform == Waveform::kMains) continue;  // its kinks are shorter than that
    EventOptions options = testing::in_nanoseconds();
    options.sampling = Sampling::kFrames;
    const auto expected = static_cast<double>(closed_form(flicker, options).size());
    const SensedEvents found =
        record<FrameCamera>(even_plane(flicker), at_rest(kFlickerDuration_s), options);
    const double per_pixel =
        static_cast<double>(found.size()) / static_cast<double>(kCamera.width * kCamera.height);
    EXPECT_NEAR(per_pixel, expected, 0.15 * expected);
  }
}

TEST(FlickeringLight, ASwitchedLightGivesSeveralEventsAtOneTime) {
  const FlickerOptions flicker{100, Waveform::kSquare, 1, 0.25, 0};
  const EventOptions options = testing::in_nanoseconds();
  const Flicker wave(flicker);
  const double change = signal(wave, options.log_eps, 0.001) - signal(wave, options.log_eps, 0.004);
  const auto count = static_cast<std::size_t>(change / options.contrast.off);
  const SensedEvents events = record<EventCamera>(even_plane(flicker), at_rest(0.009), options);
  ASSERT_EQ(events.size(), count * static_cast<std::size_t>(kCamera.width * kCamera.height));
  ASSERT_GT(count, 3U);
  for (const SensedEvent& event : events) {
    EXPECT_EQ(event.polarity, -1);
    EXPECT_NEAR(static_cast<double>(event.t_ns), 2'500'000, 1000);
  }
}

TEST(FlickeringLight, OfDepthZeroIsSteady) {
  const Scene scene = even_plane({100, Waveform::kSquare, 0, 0.5, 0});
  EXPECT_TRUE(scene.flickers().empty());
  EXPECT_TRUE(record<EventCamera>(scene, at_rest(0.05), {}).empty());
}

TEST(FlickeringLight, AmbientLightFlickers) {
  const FlickerOptions flicker{100, Waveform::kSine, 0.7, 0.5, 0};
  SceneBuilder builder;
  builder.add(testing::rectangle({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, ImageF(2, 2, 1)),
              Eigen::Affine3d::Identity());
  builder.light(0.5, {}, flicker);
  const Scene scene = std::move(builder).build(Background(0.25));
  ASSERT_EQ(scene.flickers().size(), 1U);
  for (const double t_s : {0.0, 0.002, 0.0071})
    EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, {0, 0, 1}, t_s}).radiance,
                0.5 * Flicker(flicker).at(t_s), 1e-12);
  EXPECT_EQ(testing::see(scene, {{0, 0, 0}, {0, 0, -1}, 0.002}).radiance, 0.25);
}

TEST(FlickeringLight, FramesAverageItOverTheExposureInClosedForm) {
  for (const FlickerOptions& flicker : waveforms()) {
    const Scene scene = even_plane(flicker);
    const std::vector<StampedPose> pose{{0.0123, Rigid3()}};
    for (const double exposure_s : {0.0, 0.0004, 0.0037, 0.01}) {
      const ImageF image = ImageRenderer(scene, kCamera, 1).radiance(pose, exposure_s);
      const double factor = Flicker(flicker).mean(0.0123, exposure_s);
      EXPECT_NEAR(image(3, 2), kAlbedo * (kAmbient + kIntensity * factor), 1e-6);
    }
  }
}

/// A card and a bar in front of a textured wall under a lamp that flickers, with shadows of both.
Scene lively_flickering_scene(const FlickerOptions& lamp_flicker,
                              const FlickerOptions& ambient_flicker, bool moves) {
  SceneBuilder builder;
  builder.add(testing::slanted_wall(), Eigen::Affine3d::Identity());
  builder.add(testing::ball({0.1, 0.1, 2.2}, 0.35, 16, testing::patches(128, 64, 4)),
              Eigen::Affine3d::Identity());
  const Mesh card =
      testing::rectangle({-0.3, -0.2, 1.6}, {0.3, 0, 0}, {0, 0.3, 0}, testing::patches(32, 32, 5));
  if (moves)
    builder.add_moving(card, Eigen::Affine3d::Identity(), testing::lively_motion(0.05, 1, 0.5, 7));
  else
    builder.add(card, Eigen::Affine3d::Identity());
  LightOptions lamp;
  lamp.position = {1, -1, 0};
  lamp.intensity = 3;
  lamp.flicker = lamp_flicker;
  builder.light(0.3, {lamp}, ambient_flicker);
  return std::move(builder).build(Background(0.5));
}

TEST(FlickeringLight, AgreesWithBruteForceAmongMotion) {
  const PinholeCamera crop{20, 12, 200, 200, 0.5, 4.5, {}};
  const FlickerOptions sine{100, Waveform::kSine, 0.6, 0.5, 30};
  for (const FlickerOptions& flicker : waveforms())
    for (const bool moves : {false, true}) {
      const Scene scene = lively_flickering_scene(flicker, sine, moves);
      EventOptions options;
      options.samples_per_pixel = moves ? 1 : 4;
      const testing::Agreement result =
          testing::agreement(scene, testing::lively_motion(0.05, 1.5, 1, 4), crop, options);
      std::printf("%s\n", result.text().c_str());
      EXPECT_GT(result.expected, 1000U);
      EXPECT_GE(result.share_10_us(), 0.999);
      EXPECT_GE(result.share_1_us(), 0.99);
    }
}

TEST(FlickeringLight, AdaptiveAgreesWithExactAmongMotion) {
  const PinholeCamera crop{20, 12, 200, 200, 0.5, 4.5, {}};
  const Spline motion = testing::lively_motion(0.05, 1.5, 1, 4);
  for (const FlickerOptions& flicker : waveforms()) {
    const Scene scene =
        lively_flickering_scene(flicker, {100, Waveform::kSine, 0.6, 0.5, 30}, true);
    const EventOptions options = testing::in_nanoseconds();
    Events exact, sampled;
    for (const SensedEvent& event : record<EventCamera>(scene, motion, options, crop))
      exact.push_back(event.event());
    for (const SensedEvent& event : record<AdaptiveCamera>(scene, motion, options, crop))
      sampled.push_back(event.event());
    const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 10'000));
    const double least = pairs / static_cast<double>(std::max(exact.size(), sampled.size()));
    std::printf("%zu exact and %zu adaptive events, %.4f in pairs\n", exact.size(), sampled.size(),
                least);
    EXPECT_GT(least, 0.985);
  }
}

// Of a pixel with a low pass both samplers give lines to the same filter.
TEST(FlickeringLight, TheLowPassFollowsIt) {
  for (const FlickerOptions& flicker : waveforms()) {
    EventOptions options = testing::in_nanoseconds();
    options.noise.bandwidth.cutoff_hz = 300;
    const Scene scene = even_plane(flicker);
    Events exact, sampled;
    for (const SensedEvent& event :
         record<EventCamera>(scene, at_rest(kFlickerDuration_s), options))
      exact.push_back(event.event());
    for (const SensedEvent& event :
         record<AdaptiveCamera>(scene, at_rest(kFlickerDuration_s), options))
      sampled.push_back(event.event());
    EXPECT_GT(exact.size(), 300U);
    EXPECT_LT(exact.size(), closed_form(flicker, options).size() *
                                static_cast<std::size_t>(kCamera.width * kCamera.height));
    const auto pairs = static_cast<double>(testing::count_pairs(exact, sampled, 100'000));
    EXPECT_GT(pairs / static_cast<double>(std::max(exact.size(), sampled.size())), 0.98);
  }
}

class FlickeringLightThreads : public ::testing::Test {
 protected:
  ~FlickeringLightThreads() override { set_thread_count(0); }
};

TEST_F(FlickeringLightThreads, DoNotChangeTheStream) {
  const PinholeCamera crop{40, 24, 200, 200, 20, 12, {}};
  const Scene scene = lively_flickering_scene({410, Waveform::kSquare, 0.8, 0.3, 10},
                                              {100, Waveform::kSine, 1, 0.5, 0}, true);
  const Spline motion = testing::lively_motion(0.02, 1.5, 1, 4);
  set_thread_count(1);
  const SensedEvents exact = record<EventCamera>(scene, motion, {}, crop);
  const SensedEvents sampled = record<AdaptiveCamera>(scene, motion, {}, crop);
  EXPECT_GT(exact.size(), 1000U);
  set_thread_count(3);
  EXPECT_EQ(record<EventCamera>(scene, motion, {}, crop), exact);
  EXPECT_EQ(record<AdaptiveCamera>(scene, motion, {}, crop), sampled);
}

}  // namespace
}  // namespace saccade
