#include "simulator/sensor/event_camera.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/process/parallel.h"
#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;
using testing::ExactMatch;

struct Recording {
  Events events;
  EventStatistics statistics;
};

Recording record(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                 const EventOptions& options) {
  Recording recording;
  EventCamera sensor(scene, motion, camera, options);
  double until_s = 0;
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> events, double t_s) {
    EXPECT_GE(t_s, until_s);
    until_s = t_s;
    for (const SensedEvent& event : events) recording.events.push_back(event.event());
  });
  EXPECT_EQ(until_s, motion.end_s());
  recording.statistics = sensor.statistics();
  return recording;
}

ExactMatch match(const ClosedFormPlane& plane, const EventOptions& options) {
  const Recording recording =
      record(testing::scene_of(plane), plane.motion(), plane.camera, options);
  EXPECT_LE(recording.statistics.time_bound_s, 1e-6 * options.time_tolerance_us);
  const auto expected = plane.events(options.contrast.on, options.contrast.off, options.log_eps);
  const ExactMatch result =
      testing::match_exact(expected, recording.events, plane.camera.width, plane.camera.height);
  const auto per_event = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(result.found);
  };
  std::printf(
      "events %zu of %zu, wrong pixels %zu, |dt| median %.4f p99 %.4f max %.4f us, %.2f rays and "
      "%.2f surface looks per event\n",
      result.found, result.expected, result.wrong_pixels, result.median_us, result.p99_us,
      result.max_us, per_event(recording.statistics.rays),
      per_event(recording.statistics.surface_samples));
  return result;
}

TEST(EventCamera, AgreesWithTheClosedFormInNanoseconds) {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  options.time_tolerance_us = 0.1;
  const ExactMatch result = match(ClosedFormPlane::smooth(61, 46), options);
  EXPECT_GT(result.expected, 100000U);
  EXPECT_EQ(result.found, result.expected);
  EXPECT_EQ(result.wrong_pixels, 0U);
  EXPECT_LE(result.median_us, 0.01);
  EXPECT_LE(result.max_us, 0.1);
}

TEST(EventCamera, AgreesWithTheClosedFormInMicroseconds) {
  EventOptions options;
  options.contrast = {0.21, 0.17};
  const ExactMatch result = match(ClosedFormPlane::smooth(61, 46), options);
  EXPECT_EQ(result.found, result.expected);
  EXPECT_EQ(result.wrong_pixels, 0U);
  EXPECT_LE(result.median_us, 0.3);  // rounding alone gives a quarter
  EXPECT_LE(result.p99_us, 0.6);
}

TEST(EventCamera, AgreesWithTheClosedFormWhenMagnified) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(31, 22);
  plane.metres_per_texel = 1.0 / 8;  // a texel is 6 px wide
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const ExactMatch result = match(plane, options);
  EXPECT_EQ(result.found, result.expected);
  EXPECT_EQ(result.wrong_pixels, 0U);
  EXPECT_LE(result.max_us, 1);
}

class EventCameraThreads : public ::testing::TestWithParam<int> {
 protected:
  ~EventCameraThreads() override { set_thread_count(0); }
};

TEST_P(EventCameraThreads, DoNotChangeTheStream) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(62, 45);
  const Scene scene = testing::scene_of(plane);
  const int rays = GetParam();
  EventOptions options;
  options.samples_per_pixel = rays;
  set_thread_count(1);
  const Events alone = record(scene, plane.motion(), plane.camera, options).events;
  EXPECT_GT(alone.size(), 10000U);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    EXPECT_EQ(record(scene, plane.motion(), plane.camera, options).events, alone) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(RaysPerPixel, EventCameraThreads, ::testing::Values(1, 4));

TEST(EventCamera, StreamIsInOrderAndWithinTheSensor) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(62, 45);
  const Events events = record(testing::scene_of(plane), plane.motion(), plane.camera, {}).events;
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(), EventOrder()));
  for (const Event& event : events) {
    ASSERT_LT(event.x, 62);
    ASSERT_LT(event.y, 45);
    ASSERT_EQ(event.t_ns % 1000, 0);
    ASSERT_GE(event.t_ns, 0);
    ASSERT_LE(event.t_ns, 1'000'000'000);
  }
}

// The slope of a plane wave averages to itself over a pixel, so several rays see the same ramp.
TEST(EventCamera, RampFiresAtTheSameTimesWithSeveralRaysPerPixel) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(13, 9);
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i) plane.texture(i, j) = 0.25F + 0.5F * static_cast<float>(i) / 256;
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const auto expected = plane.events(options.contrast.on, options.contrast.off, options.log_eps);
  for (const int rays : {1, 4, 16}) {
    options.samples_per_pixel = rays;
    const Events events =
        record(testing::scene_of(plane), plane.motion(), plane.camera, options).events;
    const ExactMatch result = testing::match_exact(expected, events, 13, 9);
    EXPECT_GT(result.expected, 100U);
    EXPECT_EQ(result.found, result.expected);
    EXPECT_LE(result.max_us, 1) << rays;
  }
}

/// A bright plane far away, before it a dark bar with edges at x = 0 and `width_m`, at z = 1; the
/// camera moves to the right by 1 m/s.
struct BarScene {
  static constexpr double kSpeed_m_s = 1;
  static constexpr double kStart_m = -0.15;
  PinholeCamera camera{33, 21, 100, 100, 16, 10, {}};
  double width_m;
  Scene scene;

  explicit BarScene(double width)
      : width_m(width),
        scene(testing::scene_of(
            {testing::rectangle({-40, -40, 16}, {80, 0, 0}, {0, 80, 0}, ImageF(2, 2, 0.8F)),
             testing::rectangle({0, -2, 1}, {width, 0, 0}, {0, 4, 0}, ImageF(2, 2, 0.2F))})) {}

  [[nodiscard]] Spline motion() const {
    std::vector<StampedPose> poses(2);
    for (std::size_t k = 0; k < 2; ++k) {
      poses[k].t_s = 0.3 * static_cast<double>(k);
      poses[k].world_from_camera =
          Rigid3(Eigen::Quaterniond::Identity(), {kStart_m + kSpeed_m_s * poses[k].t_s, 0, 0});
    }
    return Spline::interpolate(poses);
  }

  /// When the pixel column sees the plane x = `edge_m` at z = 1.
  [[nodiscard]] double passes_s(int x, double edge_m) const {
    return (edge_m - camera.ray({x, 0}).x() - kStart_m) / kSpeed_m_s;
  }
};

/// Checks that every pixel fires `expected` = {time, polarity} in bursts of `burst` events each.
void expect_bursts(const Events& events, int x, int y,
                   const std::vector<std::pair<double, int>>& expected, std::size_t burst) {
  std::vector<Event> mine;
  for (const Event& event : events)
    if (event.x == x && event.y == y) mine.push_back(event);
  ASSERT_EQ(mine.size(), expected.size() * burst) << x << ", " << y;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const auto& [t_s, polarity] = expected[k / burst];
    EXPECT_EQ(mine[k].polarity, polarity);
    EXPECT_NEAR(seconds_from_ns(mine[k].t_ns), t_s, 2e-6);
    EXPECT_EQ(mine[k].t_ns, mine[k / burst * burst].t_ns);
  }
}

// ln(0.801 / 0.201) / 0.15 = 9.2: nine events at each edge, together. The background hardly moves,
// so only the neighbours announce the bar.
TEST(EventCamera, OccludingEdgesAreLocated) {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const BarScene bar(0.05);
  const Recording recording = record(bar.scene, bar.motion(), bar.camera, options);
  EXPECT_LE(recording.statistics.time_bound_s, 1e-6);
  for (int x = 8; x < 30; ++x)
    for (int y = 0; y < 21; ++y)
      expect_bursts(recording.events, x, y,
                    {{bar.passes_s(x, 0), -1}, {bar.passes_s(x, bar.width_m), 1}}, 9);
}

TEST(EventCamera, BarThinnerThanAPixelIsNotJumpedOver) {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const BarScene bar(0.0055);
  const Recording recording = record(bar.scene, bar.motion(), bar.camera, options);
  for (int x = 8; x < 30; ++x)
    for (int y = 0; y < 21; ++y)
      expect_bursts(recording.events, x, y,
                    {{bar.passes_s(x, 0), -1}, {bar.passes_s(x, bar.width_m), 1}}, 9);
}

TEST(EventCamera, StandingCameraSeesNothing) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(16, 12);
  std::vector<StampedPose> poses(2);
  poses[1].t_s = 0.2;
  const Recording recording =
      record(testing::scene_of(plane), Spline::interpolate(poses), plane.camera, {});
  EXPECT_TRUE(recording.events.empty());
}

}  // namespace
}  // namespace saccade
