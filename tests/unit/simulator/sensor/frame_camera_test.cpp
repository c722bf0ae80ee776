#include "simulator/sensor/frame_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;
using testing::ExactMatch;

EventOptions frame_options(double lambda_px) {
  EventOptions options;
  options.sampling = Sampling::kFrames;
  options.frames_lambda_px = lambda_px;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  return options;
}

/// Every model within the pixels and behind them.
EventOptions noisy_options() {
  EventOptions options = frame_options(0.2);
  options.contrast = sensor_preset(SensorModel::kDavis240c).contrast;
  options.noise = sensor_preset(SensorModel::kDavis240c).noise;
  return options;
}

struct FrameRecording {
  SensedEvents events;
  std::vector<double> frames_s;
  EventStatistics statistics;
};

FrameRecording record(const ClosedFormPlane& plane, const EventOptions& options) {
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  FrameRecording recording;
  FrameCamera sensor(scene, motion, plane.camera, options);
  sensor.record(plane.duration_s, [&](std::span<const SensedEvent> events, double t_s) {
    recording.events.insert(recording.events.end(), events.begin(), events.end());
    recording.frames_s.push_back(t_s);
  });
  recording.statistics = sensor.statistics();
  return recording;
}

ExactMatch match_frames(const ClosedFormPlane& plane, const EventOptions& options) {
  Events events;
  for (const SensedEvent& event : record(plane, options).events) events.push_back(event.event());
  const auto expected = plane.events(options.contrast.on, options.contrast.off, options.log_eps);
  return testing::match_exact(expected, events, plane.camera.width, plane.camera.height);
}

TEST(FrameCamera, FramesAreLambdaOfImageMotionApart) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(9, 7);
  plane.duration_s = 0.2;
  const double speed_px_s = plane.velocity.norm() * plane.camera.fx / plane.distance_m;
  const FrameRecording recording = record(plane, frame_options(0.1));
  ASSERT_EQ(recording.frames_s.size(), std::ceil(plane.duration_s * speed_px_s / 0.1));
  for (std::size_t k = 0; k + 1 < recording.frames_s.size(); ++k)
    EXPECT_NEAR(recording.frames_s[k], static_cast<double>(k + 1) * 0.1 / speed_px_s, 1e-9);
  EXPECT_EQ(recording.frames_s.back(), plane.duration_s);
  EXPECT_NEAR(recording.statistics.time_bound_s, 0.1 / speed_px_s, 1e-9);
  EXPECT_EQ(recording.statistics.rays, 9 * 7 * (recording.frames_s.size() + 1));
}

TEST(FrameCamera, FramesOfAFixedRate) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(9, 7);
  plane.duration_s = 0.1;
  EventOptions options = frame_options(0.1);
  options.frames_rate_hz = 300;
  const std::vector<double> frames_s = record(plane, options).frames_s;
  ASSERT_EQ(frames_s.size(), 30U);
  for (std::size_t k = 0; k < 30; ++k)
    EXPECT_DOUBLE_EQ(frames_s[k], static_cast<double>(k + 1) / 300);
}

// Radiance e^(a t): log intensity is a line but for eps, so every frame rate finds the same times.
TEST(FrameCamera, TimesOfALogarithmicRampAreExact) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(5, 3);
  plane.velocity = {0.25, 0};
  for (int j = 0; j < plane.texture.height(); ++j)
    for (int i = 0; i < plane.texture.width(); ++i)
      plane.texture(i, j) = std::exp(0.02F * static_cast<float>(i)) - 1e-3F;
  const ExactMatch result = match_frames(plane, frame_options(0.5));
  EXPECT_GT(result.expected, 10U);
  EXPECT_EQ(result.found, result.expected);
  EXPECT_EQ(result.wrong_pixels, 0U);
  // Within a texel the radiance is linear: its chord is 0.02^2 / 8 log units off.
  const double log_per_s = 0.02 * plane.velocity.x() / plane.metres_per_texel;
  EXPECT_LE(result.max_us, 1e6 * 0.02 * 0.02 / 8 / log_per_s);
}

TEST(FrameCamera, TimeErrorIsOfSecondOrderInLambda) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(31, 22);
  plane.metres_per_texel = 1.0 / 8;  // a texel is several pixels wide
  const ExactMatch coarse = match_frames(plane, frame_options(0.2));
  const ExactMatch fine = match_frames(plane, frame_options(0.05));
  const ExactMatch finest = match_frames(plane, frame_options(0.0125));
  std::printf("median |dt| %.3f, %.3f, %.4f us\n", coarse.median_us, fine.median_us,
              finest.median_us);
  EXPECT_GT(coarse.expected, 1000U);
  EXPECT_NEAR(coarse.median_us / fine.median_us, 16, 4);
  EXPECT_NEAR(fine.median_us / finest.median_us, 16, 4);
}

TEST(FrameCamera, StaticCameraSeesNothing) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(9, 7);
  plane.velocity = {0, 0};
  plane.duration_s = 0.1;
  const FrameRecording recording = record(plane, frame_options(0.1));
  EXPECT_TRUE(recording.events.empty());
  EXPECT_NEAR(recording.statistics.time_bound_s, 0.01, 1e-9);
}

TEST(FrameCamera, LeakingReferenceFiresBeforeAStaticScene) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(9, 7);
  plane.velocity = {0, 0};
  plane.duration_s = 2;
  EventOptions options = frame_options(0.1);
  options.noise.leak.rate_hz = 10;
  const FrameRecording recording = record(plane, options);
  EXPECT_NEAR(static_cast<double>(recording.events.size()), 9 * 7 * 20, 9 * 7);
  for (const SensedEvent& event : recording.events) ASSERT_EQ(event.origin, EventOrigin::kLeak);
}

class FrameCameraThreads : public ::testing::TestWithParam<int> {
 protected:
  ~FrameCameraThreads() override { set_thread_count(0); }
};

TEST_P(FrameCameraThreads, DoNotChangeTheStream) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(30, 23);
  plane.duration_s = 0.2;
  EventOptions options = noisy_options();
  options.samples_per_pixel = GetParam();
  set_thread_count(1);
  const SensedEvents alone = record(plane, options).events;
  EXPECT_GT(alone.size(), 1000U);
  EXPECT_TRUE(std::is_sorted(alone.begin(), alone.end(), SensedEventOrder()));
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    EXPECT_EQ(record(plane, options).events, alone) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(RaysPerPixel, FrameCameraThreads, ::testing::Values(1, 4, 16));

TEST(FrameCamera, ResumesToTheSameStream) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(30, 23);
  plane.duration_s = 0.2;
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  for (const EventOptions& options : {frame_options(0.2), noisy_options()}) {
    SensedEvents until_then, afterwards;
    std::string state;
    FrameCamera whole(scene, motion, plane.camera, options);
    whole.record(plane.duration_s, [&](std::span<const SensedEvent> events, double t_s) {
      SensedEvents& part = state.empty() ? until_then : afterwards;
      part.insert(part.end(), events.begin(), events.end());
      if (state.empty() && t_s > 0.08) state = whole.state();
    });
    FrameCamera second(scene, motion, plane.camera, options);
    second.resume(state);
    SensedEvents resumed;
    second.record(plane.duration_s, [&](std::span<const SensedEvent> events, double) {
      resumed.insert(resumed.end(), events.begin(), events.end());
    });
    EXPECT_GT(until_then.size(), 100U);
    EXPECT_GT(afterwards.size(), 100U);
    EXPECT_EQ(resumed, afterwards);
    EXPECT_EQ(second.statistics().rays, whole.statistics().rays);
    FrameCamera third(scene, motion, plane.camera, options);
    EXPECT_THROW(third.resume(state.substr(0, state.size() - 1)), InputError);
    EXPECT_THROW(third.resume(state + "x"), InputError);
  }
}

}  // namespace
}  // namespace saccade
