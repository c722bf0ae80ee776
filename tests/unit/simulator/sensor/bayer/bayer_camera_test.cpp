#include "simulator/sensor/bayer/bayer_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/process/parallel.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/frame_camera.h"
#include "tests/support/brute_force.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;
using testing::ExactEvent;

/// A plane whose red, green and blue light are pictures of their own.
struct ColouredPlane {
  ClosedFormPlane red = plane(1), green = plane(0.35), blue = plane(-0.6);

  static ClosedFormPlane plane(double power) {
    ClosedFormPlane plane = ClosedFormPlane::smooth(25, 14);
    plane.duration_s = 0.3;
    for (float& value : plane.texture.pixels()) value = std::pow(value, static_cast<float>(power));
    return plane;
  }
  [[nodiscard]] const ClosedFormPlane& of(int x, int y) const {
    return y % 2 == 0 ? (x % 2 == 0 ? red : green) : (x % 2 == 0 ? green : blue);
  }
  [[nodiscard]] ColourScenes scenes() const {
    return {testing::scene_of(red), testing::scene_of(green), testing::scene_of(blue)};
  }
  /// The events of every pixel in the light of its colour.
  [[nodiscard]] std::vector<ExactEvent> events(const EventOptions& options) const {
    std::vector<ExactEvent> all;
    for (const ClosedFormPlane* channel : {&red, &green, &blue})
      for (const ExactEvent& event :
           channel->events(options.contrast.on, options.contrast.off, options.log_eps))
        if (&of(event.x, event.y) == channel) all.push_back(event);
    return all;
  }
};

template <class Camera>
SensedEvents record(Camera& camera, double duration_s) {
  SensedEvents all;
  camera.record(duration_s, [&](std::span<const SensedEvent> events, double) {
    all.insert(all.end(), events.begin(), events.end());
  });
  return all;
}

Events plain(const SensedEvents& sensed) {
  Events events;
  for (const SensedEvent& event : sensed) events.push_back(event.event());
  return events;
}

EventOptions noisy() {
  EventOptions options = testing::in_nanoseconds();
  options.contrast = sensor_preset(SensorModel::kDavis240c).contrast;
  options.noise = sensor_preset(SensorModel::kDavis240c).noise;
  return options;
}

TEST(BayerPart, SeesEverySecondPixelOfTheSensor) {
  const PinholeCamera camera{41, 30, 60, 63, 21, 14, {-0.2, 0.05, 0.003, -0.002, 0}};
  std::size_t pixels = 0;
  for (const BayerPart& part : kBayerParts) {
    const PinholeCamera half = part.of(camera);
    pixels += static_cast<std::size_t>(half.width * half.height);
    for (int y = 0; y < half.height; ++y)
      for (int x = 0; x < half.width; ++x) {
        const Eigen::Vector3d expected =
            camera.ray(camera.undistort({part.x0 + 2 * x, part.y0 + 2 * y}));
        EXPECT_LT((half.ray(half.undistort({x, y})) - expected).norm(), 1e-9);
      }
  }
  EXPECT_EQ(pixels, 41U * 30U);
}

// Its 4 and 16 rays are those of the whole sensor's pixels.
TEST(BayerPart, SeesPixelsOfTheSensorsSize) {
  const PinholeCamera camera{16, 12, 60, 63, 8, 6, {-0.1, 0, 0, 0, 0}};
  const PixelRays whole(camera, 4);
  for (const BayerPart& part : kBayerParts) {
    const PixelRays half(part.of(camera), 4, kBayerPixelSide);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t pixel = static_cast<std::size_t>(4 * part.y0 + part.x0);
      EXPECT_LT((half.rays(0)[k] - whole.rays(0)[4 * pixel + k]).norm(), 1e-9);
    }
    EXPECT_LT((half.differential({0.02, 0.01, 1}) - whole.differential({0.02, 0.01, 1})).norm(),
              1e-9);
  }
}

TEST(BayerCamera, EveryPixelFiresInTheLightOfItsColour) {
  const ColouredPlane plane;
  const EventOptions options = testing::in_nanoseconds();
  const ColourScenes scenes = plane.scenes();
  const Spline motion = plane.red.motion();
  BayerCamera<EventCamera> camera(scenes, motion, plane.red.camera, options);
  const SensedEvents found = record(camera, plane.red.duration_s);
  EXPECT_TRUE(std::ranges::is_sorted(found, SensedEventOrder()));
  const testing::ExactMatch match = testing::match_exact(
      plane.events(options), plain(found), plane.red.camera.width, plane.red.camera.height);
  EXPECT_GT(match.expected, 1000U);
  EXPECT_EQ(match.found, match.expected);
  EXPECT_EQ(match.wrong_pixels, 0U);
  EXPECT_LE(match.p99_us, 1);
}

// Of three like scenes the filter makes no difference, whatever the rays of a pixel and the filter
// of textures.
TEST(BayerCamera, BeforeGreyItIsTheGreyCamera) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(25, 14);
  plane.duration_s = 0.2;
  plane.metres_per_texel /= 4;  // finer than the pixels
  const Scene scene = testing::scene_of(plane);
  const ColourScenes scenes{testing::scene_of(plane), testing::scene_of(plane),
                            testing::scene_of(plane)};
  const Spline motion = plane.motion();
  for (const int rays : {1, 4}) {
    EventOptions options = testing::in_nanoseconds();
    options.samples_per_pixel = rays;
    options.texture_filter = rays == 4 ? TextureFilter::kMipmap : TextureFilter::kBilinear;
    EventCamera grey(scene, motion, plane.camera, options);
    BayerCamera<EventCamera> filtered(scenes, motion, plane.camera, options);
    const Events expected = plain(record(grey, plane.duration_s));
    const Events found = plain(record(filtered, plane.duration_s));
    EXPECT_GT(expected.size(), 1000U);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_EQ(testing::count_pairs(expected, found, 2'000), expected.size());
  }
}

TEST(BayerCamera, OtherSamplingsAgree) {
  const ColouredPlane plane;
  EventOptions options = testing::in_nanoseconds();
  options.frames_lambda_px = 0.1;
  options.audit_fraction = 0.2;
  const ColourScenes scenes = plane.scenes();
  const Spline motion = plane.red.motion();
  BayerCamera<EventCamera> exact(scenes, motion, plane.red.camera, options);
  BayerCamera<AdaptiveCamera> adaptive(scenes, motion, plane.red.camera, options);
  BayerCamera<FrameCamera> frames(scenes, motion, plane.red.camera, options);
  const Events truth = plain(record(exact, plane.red.duration_s));
  const auto share = [&](const Events& found, TimeNs tolerance_ns) {
    return static_cast<double>(testing::count_pairs(truth, found, tolerance_ns)) /
           static_cast<double>(std::max(truth.size(), found.size()));
  };
  EXPECT_GT(share(plain(record(adaptive, plane.red.duration_s)), 10'000), 0.995);
  EXPECT_GT(share(plain(record(frames, plane.red.duration_s)), 500'000), 0.97);
  // At least a fifth of the tiles of each part, of 13 x 7 or 12 x 7 pixels.
  const AuditResult audit = adaptive.audit();
  EXPECT_GE(audit.pixels, 70U);
  EXPECT_GT(audit.exact_events, 200U);
  EXPECT_GT(audit.precision_10us.value, 0.98);
}

TEST(BayerCamera, TheSensorsReadoutIsShared) {
  const ColouredPlane plane;
  EventOptions options = testing::in_nanoseconds();
  options.noise.readout.rate_hz = 20'000;
  const ColourScenes scenes = plane.scenes();
  const Spline motion = plane.red.motion();
  BayerCamera<EventCamera> camera(scenes, motion, plane.red.camera, options);
  const SensedEvents events = record(camera, plane.red.duration_s);
  ASSERT_GT(events.size(), 1000U);
  for (std::size_t k = 1; k < events.size(); ++k)
    EXPECT_GE(events[k].t_ns - events[k - 1].t_ns, 50'000 - 2);
}

class BayerCameraThreads : public ::testing::Test {
 protected:
  ~BayerCameraThreads() override { set_thread_count(0); }
};

TEST_F(BayerCameraThreads, DoNotChangeTheStream) {
  const ColouredPlane plane;
  const ColourScenes scenes = plane.scenes();
  const Spline motion = plane.red.motion();
  set_thread_count(1);
  BayerCamera<EventCamera> alone(scenes, motion, plane.red.camera, noisy());
  const SensedEvents expected = record(alone, plane.red.duration_s);
  EXPECT_GT(expected.size(), 500U);
  set_thread_count(3);
  BayerCamera<EventCamera> camera(scenes, motion, plane.red.camera, noisy());
  EXPECT_EQ(record(camera, plane.red.duration_s), expected);
}

TEST(BayerCamera, ResumesToTheSameStream) {
  const ColouredPlane plane;
  const ColourScenes scenes = plane.scenes();
  const Spline motion = plane.red.motion();
  SensedEvents afterwards;
  std::string state;
  BayerCamera<AdaptiveCamera> whole(scenes, motion, plane.red.camera, noisy());
  whole.record(plane.red.duration_s, [&](std::span<const SensedEvent> events, double t_s) {
    if (!state.empty()) afterwards.insert(afterwards.end(), events.begin(), events.end());
    if (state.empty() && t_s > 0.1) state = whole.state();
  });
  BayerCamera<AdaptiveCamera> second(scenes, motion, plane.red.camera, noisy());
  second.resume(state);
  EXPECT_GT(afterwards.size(), 100U);
  EXPECT_EQ(record(second, plane.red.duration_s), afterwards);
  BayerCamera<AdaptiveCamera> third(scenes, motion, plane.red.camera, noisy());
  EXPECT_THROW(third.resume(state + "x"), InputError);
  EXPECT_THROW(third.resume(state.substr(0, state.size() - 1)), InputError);
}

}  // namespace
}  // namespace saccade
