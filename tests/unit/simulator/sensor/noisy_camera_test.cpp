#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/process/parallel.h"
#include "simulator/sensor/event_camera.h"
#include "tests/unit/simulator/scene/plane_scene.h"
#include "tests/unit/simulator/sensor/noise/log_eps.h"
#include "tests/unit/simulator/sensor/noise/statistics.h"

namespace saccade {
namespace {

using testing::kLogEps;

Spline line(const Eigen::Vector3d& to, double duration_s) {
  std::vector<StampedPose> poses(2);
  poses[1] = {duration_s, Rigid3(Eigen::Quaterniond::Identity(), to)};
  return Spline::interpolate(poses);
}

/// A scene, a camera and its motion, which the recordings below share.
struct World {
  Scene scene;
  PinholeCamera camera;
  Spline motion;

  [[nodiscard]] SensedEvents record(const EventOptions& options) const {
    SensedEvents events;
    EventCamera sensor(scene, motion, camera, options, 5);
    sensor.record(motion.end_s(), [&](std::span<const SensedEvent> some, double) {
      events.insert(events.end(), some.begin(), some.end());
    });
    return events;
  }
};

/// One grey value before a standing camera.
World still(double radiance, double duration_s, int width = 24, int height = 16) {
  return {testing::scene_of({testing::rectangle({-40, -40, 2}, {80, 0, 0}, {0, 80, 0},
                                                ImageF(2, 2, static_cast<float>(radiance)))}),
          {width, height, 80, 80, 0.5 * width, 0.5 * height, {}},
          line({0, 0, 0}, duration_s)};
}

/// I = exp(kRampSlope t + what the column adds) - eps, up to the interpolation between 4096 texels:
/// the log intensity rises by kRampSlope per second at every pixel.
constexpr double kRampSlope = 2;
World ramp(double duration_s) {
  constexpr int kTexels = 4096;
  ImageF texture(kTexels, 2);
  const double least = std::log(0.02);
  const double per_texel = std::log(40.0) / kTexels;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < kTexels; ++x)
      texture(x, y) = static_cast<float>(std::exp(least + per_texel * x) - kLogEps);
  // 4 m for ln 40: so many metres per second for kRampSlope.
  const double speed = 4 * kRampSlope / std::log(40.0);
  return {testing::scene_of({testing::rectangle({-1, -2, 2}, {4, 0, 0}, {0, 4, 0}, texture)}),
          {16, 12, 80, 80, 7.5, 5.5, {}},
          line({speed * duration_s, 0, 0}, duration_s)};
}

/// A bright plane, then, from the time it reaches a pixel, a dark one: ln I jumps by `change`.
World edge(double bright, double dark, double duration_s) {
  return {testing::scene_of({testing::rectangle({-40, -40, 16}, {80, 0, 0}, {0, 80, 0},
                                                ImageF(2, 2, static_cast<float>(bright))),
                             testing::rectangle({0, -2, 1}, {3, 0, 0}, {0, 4, 0},
                                                ImageF(2, 2, static_cast<float>(dark)))}),
          {16, 8, 100, 100, 7.5, 3.5, {}},
          line({0.3, 0, 0}, duration_s)};
}

SensedEvents of_pixel(const SensedEvents& events, int x, int y) {
  SensedEvents mine;
  for (const SensedEvent& event : events)
    if (event.x == x && event.y == y) mine.push_back(event);
  return mine;
}

std::vector<double> counts(const SensedEvents& events, const PinholeCamera& camera) {
  std::vector<double> counts(static_cast<std::size_t>(camera.width * camera.height));
  for (const SensedEvent& event : events)
    ++counts[static_cast<std::size_t>(event.y * camera.width + event.x)];
  return counts;
}

// The texture is linear between texels: ln I departs by (ln 40 / 4096)^2 / 8 = 1e-7 from the ramp.
TEST(NoisyCamera, RefractoryPeriodMakesARampFireAtItsReciprocalRate) {
  EventOptions options = testing::in_nanoseconds();
  options.noise.refractory.period_us = 20'000;
  const double gap_s = 0.02 + options.contrast.on / kRampSlope;
  const World world = ramp(0.6);
  for (const int x : {2, 9}) {
    const SensedEvents events = of_pixel(world.record(options), x, 5);
    ASSERT_EQ(events.size(), static_cast<std::size_t>(std::floor((0.6 + 0.02) / gap_s)));
    for (std::size_t k = 0; k < events.size(); ++k) {
      const double expected_s = static_cast<double>(k + 1) * gap_s - 0.02;
      EXPECT_NEAR(seconds_from_ns(events[k].t_ns), expected_s, 3e-6);  // float texels: 1e-7 of L
      EXPECT_EQ(events[k].polarity, 1);
      EXPECT_EQ(events[k].origin, EventOrigin::kSignal);
    }
  }
}

// Also: minutes in, nanoseconds still tell; float32 seconds would step by 7.6 us.
TEST(NoisyCamera, LeakFiresAtItsRateBeforeAStaticScene) {
  EventOptions options = testing::in_nanoseconds();
  options.noise.leak.rate_hz = 0.7;
  const World world = still(0.4, 130.5, 4, 4);
  const SensedEvents events = of_pixel(world.record(options), 1, 2);
  ASSERT_NEAR(static_cast<double>(events.size()), 130.5 * 0.7, 1);
  const auto first_ns = static_cast<double>(events[0].t_ns);
  for (std::size_t k = 0; k < events.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(events[k].t_ns), first_ns + 1e9 * static_cast<double>(k) / 0.7,
                2002);
    EXPECT_EQ(events[k].polarity, 1);
    EXPECT_EQ(events[k].origin, EventOrigin::kLeak);
  }
}

/// The leak has been at work before: a pixel's first event comes at any time of its period.
TEST(NoisyCamera, LeakHasItsRateFromTheStartOn) {
  EventOptions options = testing::in_nanoseconds();
  options.noise.leak.rate_hz = 0.7;
  const World world = still(0.4, 0.9);
  const double share = 0.9 * 0.7;
  const double pixels = 24 * 16;
  const SensedEvents events = world.record(options);
  EXPECT_NEAR(static_cast<double>(events.size()), share * pixels,
              kSigmas * std::sqrt(share * (1 - share) * pixels));
  std::vector<double> times_s;
  for (const SensedEvent& event : events) times_s.push_back(seconds_from_ns(event.t_ns));
  const auto count = static_cast<double>(times_s.size());
  EXPECT_NEAR(moments_of(times_s).mean, 0.45, kSigmas * 0.9 / std::sqrt(12 * count));
}

TEST(NoisyCamera, ShotNoiseIsPoissonAtTheRateOfTheIntensity) {
  EventOptions options = testing::in_nanoseconds();
  options.contrast = {5, 5};
  options.noise.shot.rate_hz = 20;
  for (const double radiance : {0.0, 0.5, 1.0}) {
    const World world = still(radiance, 1.5);
    const SensedEvents events = world.record(options);
    const std::vector<double> values = counts(events, world.camera);
    const auto pixels = static_cast<double>(values.size());
    const double expected = 1.5 * 20 * (1 - 0.75 * radiance);
    const Moments moments = moments_of(values);
    EXPECT_NEAR(moments.mean, expected, kSigmas * std::sqrt(expected / pixels));
    const double dispersion = (pixels - 1) * moments.variance / moments.mean;
    EXPECT_GT(dispersion, chi_square_bound(pixels - 1, -kSigmas));
    EXPECT_LT(dispersion, chi_square_bound(pixels - 1, kSigmas));
    for (const SensedEvent& event : events) ASSERT_EQ(event.origin, EventOrigin::kShot);
  }
}

/// The gap of a ramp is a pixel's threshold by the slope: their spread is that of the thresholds.
TEST(NoisyCamera, MismatchIsRecoveredFromARampAndStaysWithThePixel) {
  EventOptions options = testing::in_nanoseconds();
  options.noise.mismatch.sigma = 0.1;
  const World world = ramp(0.6);
  const SensedEvents events = world.record(options);
  std::vector<double> thresholds;
  for (int y = 0; y < world.camera.height; ++y)
    for (int x = 0; x < world.camera.width; ++x) {
      const SensedEvents mine = of_pixel(events, x, y);
      ASSERT_GE(mine.size(), 2U);
      const double threshold = kRampSlope * seconds_from_ns(mine[0].t_ns);
      thresholds.push_back(threshold / options.contrast.on);
      for (std::size_t k = 1; k < mine.size(); ++k)
        ASSERT_NEAR(kRampSlope * seconds_from_ns(mine[k].t_ns - mine[k - 1].t_ns), threshold, 1e-5);
    }
  const auto pixels = static_cast<double>(thresholds.size());
  const Moments moments = moments_of(thresholds);
  EXPECT_NEAR(moments.mean, 1, kSigmas * 0.1 / std::sqrt(pixels));
  const double chi_square = (pixels - 1) * moments.variance / 0.01;
  EXPECT_GT(chi_square, chi_square_bound(pixels - 1, -kSigmas));
  EXPECT_LT(chi_square, chi_square_bound(pixels - 1, kSigmas));
}

/// With a = w t, an edge of dL has come through to dL (1 - e^-a), of order 2 to
/// dL (1 - (1 + a) e^-a).
TEST(NoisyCamera, LowPassDelaysAnEdgeByItsStepResponse) {
  const double bright = 0.8;
  const double dark = 0.2;
  const double change = std::log((bright + kLogEps) / (dark + kLogEps));
  const double cutoff_hz = 100;
  const double rate = 2 * std::numbers::pi * cutoff_hz * (dark + 0.08) / 1.08;
  const World world = edge(bright, dark, 0.35);
  const SensedEvents ideal = of_pixel(world.record(testing::in_nanoseconds()), 6, 3);
  ASSERT_EQ(ideal.size(), 9U);
  for (const int order : {1, 2}) {
    EventOptions options = testing::in_nanoseconds();
    options.noise.bandwidth.cutoff_hz = cutoff_hz;
    options.noise.bandwidth.order = order;
    const SensedEvents events = of_pixel(world.record(options), 6, 3);
    ASSERT_EQ(events.size(), 9U);
    for (std::size_t k = 0; k < events.size(); ++k) {
      const double a = rate * seconds_from_ns(events[k].t_ns - ideal[k].t_ns);
      const double response = 1 - (order == 1 ? 1 : 1 + a) * std::exp(-a);
      const double level = static_cast<double>(k + 1) * options.contrast.off / change;
      EXPECT_NEAR(response, level, rate * 3e-6) << order << " " << k;
      if (order == 1) {
        EXPECT_NEAR(a, -std::log(1 - level), 2e-3);
      }
    }
  }
}

TEST(NoisyCamera, HotPixelsAloneFireBeforeAStaticScene) {
  EventOptions options = testing::in_nanoseconds();
  options.noise.hot = {0.1, 50, 0};
  const World world = still(0.4, 2);
  const SensedEvents events = world.record(options);
  double hot = 0;
  for (const double count : counts(events, world.camera)) {
    if (count == 0) continue;
    ++hot;
    EXPECT_NEAR(count, 100, kSigmas * std::sqrt(100.0));
  }
  const double pixels = 24 * 16;
  EXPECT_NEAR(hot, 0.1 * pixels, kSigmas * std::sqrt(0.09 * pixels));
  for (const SensedEvent& event : events) {
    ASSERT_EQ(event.origin, EventOrigin::kHot);
    ASSERT_EQ(event.polarity, 1);
  }
}

using Model = std::pair<const char*, std::function<void(NoiseOptions&)>>;

const std::vector<Model>& exact_models() {
  static const std::vector<Model> models = {
      {"refractory", [](NoiseOptions& noise) { noise.refractory.period_us = 3000; }},
      {"leak",
       [](NoiseOptions& noise) {
         noise.leak = {4, 0.2};
       }},
      {"mismatch", [](NoiseOptions& noise) { noise.mismatch.sigma = 0.15; }},
      {"shot", [](NoiseOptions& noise) { noise.shot.rate_hz = 20; }},
      {"hot", [](NoiseOptions& noise) {
         noise.hot = {0.2, 30, 0.5};
       }}};
  return models;
}

World lively_plane() {
  const testing::ClosedFormPlane plane = testing::ClosedFormPlane::smooth(14, 10);
  return {testing::scene_of(plane), plane.camera, plane.motion()};
}

/// The same polarities and origins, pixel by pixel, at times within `tolerance_ns`.
void expect_same(const SensedEvents& a, const SensedEvents& b, TimeNs tolerance_ns,
                 const PinholeCamera& camera) {
  EXPECT_EQ(a.size(), b.size());
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const SensedEvents first = of_pixel(a, x, y);
      const SensedEvents second = of_pixel(b, x, y);
      ASSERT_EQ(first.size(), second.size()) << x << ", " << y;
      for (std::size_t k = 0; k < first.size(); ++k) {
        ASSERT_EQ(first[k].polarity, second[k].polarity);
        ASSERT_EQ(first[k].origin, second[k].origin);
        ASSERT_LE(std::abs(first[k].t_ns - second[k].t_ns), tolerance_ns) << x << ", " << y;
      }
    }
}

TEST(NoisyCamera, EventsDoNotDependOnHowDenselyTheSignalIsSampled) {
  const World world = lively_plane();
  for (const auto& [name, set] : exact_models()) {
    SCOPED_TRACE(name);
    EventOptions options = testing::in_nanoseconds();
    set(options.noise);
    const SensedEvents events = world.record(options);
    for (const double step_px : {0.05, 0.317}) {
      options.max_step_px = step_px;
      expect_same(world.record(options), events, 1000, world.camera);
    }
  }
}

EventOptions with_everything() {
  EventOptions options = testing::in_nanoseconds();
  for (const auto& [name, set] : exact_models()) set(options.noise);
  options.noise.bandwidth.cutoff_hz = 300;
  options.noise.latency = {50, 5};
  options.noise.readout = {3e6, true, 100};
  return options;
}

class NoisyCameraThreads : public ::testing::Test {
 protected:
  ~NoisyCameraThreads() override { set_thread_count(0); }
};

TEST_F(NoisyCameraThreads, DoNotChangeTheStream) {
  const World world = lively_plane();
  set_thread_count(1);
  const SensedEvents alone = world.record(with_everything());
  EXPECT_GT(alone.size(), 1000U);
  for (const int threads : {2, 8}) {
    set_thread_count(threads);
    EXPECT_EQ(world.record(with_everything()), alone) << threads;
  }
}

TEST(NoisyCamera, ResumedGoesOnWithTheSameStream) {
  const World world = lively_plane();
  const EventOptions options = with_everything();
  SensedEvents before;
  std::string state;
  SensedEvents all;
  EventCamera sensor(world.scene, world.motion, world.camera, options, 5);
  sensor.record(world.motion.end_s(), [&](std::span<const SensedEvent> some, double t_s) {
    all.insert(all.end(), some.begin(), some.end());
    if (state.empty() && t_s > 0.4 * world.motion.end_s()) {
      before = all;
      state = sensor.state();
    }
  });
  EventCamera resumed(world.scene, world.motion, world.camera, options, 5);
  resumed.resume(state);
  resumed.record(world.motion.end_s(), [&](std::span<const SensedEvent> some, double) {
    before.insert(before.end(), some.begin(), some.end());
  });
  EXPECT_EQ(before, all);
}

TEST(NoisyCamera, ZeroStrengthIsTheIdealStream) {
  const World world = lively_plane();
  EventOptions options = testing::in_nanoseconds();
  const SensedEvents ideal = world.record(options);
  options.noise.leak = {0, 0.5};
  options.noise.shot = {0, 0.1, 1};
  options.noise.hot = {0, 50, 0.5};
  options.noise.bandwidth.order = 2;
  EXPECT_EQ(world.record(options), ideal);
}

// ln I rises by 5e-5 per second, 5e-7 per look. Float texels are 6e-8 from the ramp and the
// interpolation 1e-7, together less than 5 ms.
TEST(NoisyCamera, SlowRampIsNotLost) {
  World slow = ramp(1);
  slow.camera.width = slow.camera.height = 4;
  slow.motion = line({4 * 0.0015 / std::log(40.0), 0, 0}, 30);
  EventOptions options = testing::in_nanoseconds();
  options.contrast = {0.001, 0.001};
  const SensedEvents events = of_pixel(slow.record(options), 1, 2);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_NEAR(seconds_from_ns(events[0].t_ns), 20, 5e-3);
}

}  // namespace
}  // namespace saccade
