#include "simulator/sensor/event_camera.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;
using testing::ExactMatch;

EventOptions exact_options() {
  EventOptions options;
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  options.time_tolerance_us = 0.1;
  return options;
}

struct Recording {
  Events events;
  EventStatistics statistics;
};

Recording record(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                 const EventOptions& options, double duration_s) {
  Recording recording;
  EventCamera sensor(scene, motion, camera, options);
  sensor.record(duration_s, [&](std::span<const Event> events, double) {
    recording.events.insert(recording.events.end(), events.begin(), events.end());
  });
  recording.statistics = sensor.statistics();
  return recording;
}

ExactMatch match(const ClosedFormPlane& plane, const EventOptions& options) {
  const Recording recording =
      record(testing::scene_of(plane), plane.motion(), plane.camera, options, plane.duration_s);
  EXPECT_LE(recording.statistics.time_bound_s, 1e-6 * options.time_tolerance_us);
  const auto expected = plane.events(options.contrast.on, options.contrast.off, options.log_eps);
  const ExactMatch result =
      testing::match_exact(expected, recording.events, plane.camera.width, plane.camera.height);
  std::printf(
      "events %zu of %zu, wrong pixels %zu, |dt| median %.4f p99 %.4f max %.4f us, "
      "%.2f rays and %.2f looks per event\n",
      result.found, result.expected, result.wrong_pixels, result.median_us, result.p99_us,
      result.max_us,
      static_cast<double>(recording.statistics.rays) / static_cast<double>(result.found),
      static_cast<double>(recording.statistics.surface_looks) / static_cast<double>(result.found));
  return result;
}

TEST(EventCamera, AgreesWithTheClosedFormInNanoseconds) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(61, 46);
  const ExactMatch result = match(plane, exact_options());
  EXPECT_GT(result.expected, 10000U);
  EXPECT_EQ(result.found, result.expected);
  EXPECT_EQ(result.wrong_pixels, 0U);
  EXPECT_LE(result.median_us, 0.1);
  EXPECT_LE(result.p99_us, 1);
}

}  // namespace
}  // namespace saccade
