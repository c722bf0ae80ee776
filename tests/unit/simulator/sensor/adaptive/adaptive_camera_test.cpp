#include "simulator/sensor/adaptive/adaptive_camera.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/process/parallel.h"
#include "core/random.h"
#include "simulator/event_source.h"
#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;

EventOptions adaptive_options() {
  EventOptions options = testing::in_nanoseconds();
  options.sampling = Sampling::kAdaptive;
  return options;
}

EventOptions noisy_options() {
  EventOptions options = adaptive_options();
  options.contrast = sensor_preset(SensorModel::kDavis240c).contrast;
  options.noise = sensor_preset(SensorModel::kDavis240c).noise;
  return options;
}

template <class Camera>
SensedEvents record(Camera& camera, double duration_s) {
  SensedEvents all;
  camera.record(duration_s, [&](std::span<const SensedEvent> events, double) {
    all.insert(all.end(), events.begin(), events.end());
  });
  return all;
}

/// Precision and recall within 10 us of all pixels.
std::pair<double, double> compare(const SensedEvents& exact, const SensedEvents& sampled, int width,
                                  int height) {
  std::vector<EventMatcher> matchers(static_cast<std::size_t>(2 * width * height));
  const auto matcher = [&](const SensedEvent& event) -> EventMatcher& {
    return matchers[static_cast<std::size_t>(2 * (event.y * width + event.x) +
                                             (event.polarity > 0 ? 1 : 0))];
  };
  for (const SensedEvent& event : exact) matcher(event).add_exact(event.t_ns);
  for (const SensedEvent& event : sampled) matcher(event).add_sampled(event.t_ns);
  MatchCounts counts;
  for (EventMatcher& one : matchers) one.advance(std::numeric_limits<TimeNs>::max() / 2, counts);
  const auto matched = static_cast<double>(counts.matched[1]);
  return {matched / static_cast<double>(sampled.size()),
          matched / static_cast<double>(exact.size())};
}

/// Cards of random brightness at random depths before a textured plane: half of the view lies next
/// to an occlusion.
Scene cards(const ClosedFormPlane& plane) {
  const Random random(5);
  const Eigen::Vector2d size =
      plane.metres_per_texel * Eigen::Vector2d(plane.texture.width(), plane.texture.height());
  std::vector<Mesh> meshes = {
      testing::rectangle({-0.5 * size.x(), -0.5 * size.y(), plane.distance_m}, {size.x(), 0, 0},
                         {0, size.y(), 0}, plane.texture)};
  for (std::uint64_t k = 0; k < 12; ++k) {
    const auto uniform = [&](std::uint64_t draw, double low, double high) {
      return low + (high - low) * random.uniform(k, draw);
    };
    ImageF grey(1, 1);
    grey(0, 0) = static_cast<float>(uniform(0, 0.05, 0.9));
    const double z = uniform(1, 0.6, 0.95) * plane.distance_m;
    const double width = uniform(2, 0.05, 0.3) * z;
    meshes.push_back(testing::rectangle({uniform(3, -0.4, 0.3) * z, uniform(4, -0.3, 0.25) * z, z},
                                        {width, 0.2 * width, 0}, {-0.2 * width, width, 0}, grey));
  }
  return testing::scene_of(meshes);
}

ClosedFormPlane moving_plane() {
  ClosedFormPlane plane = ClosedFormPlane::smooth(48, 36);
  plane.duration_s = 0.2;
  return plane;
}

TEST(AdaptiveCamera, FindsTheEventsOfATexture) {
  ClosedFormPlane plane = moving_plane();
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  EventCamera exact(scene, motion, plane.camera, adaptive_options());
  AdaptiveCamera sampled(scene, motion, plane.camera, adaptive_options());
  const SensedEvents truth = record(exact, plane.duration_s);
  const auto [precision, recall] =
      compare(truth, record(sampled, plane.duration_s), plane.camera.width, plane.camera.height);
  EXPECT_GT(truth.size(), 3000U);
  EXPECT_GT(precision, 0.999);
  EXPECT_GT(recall, 0.999);
  EXPECT_EQ(sampled.statistics().time_bound_s, 0);
}

TEST(AdaptiveCamera, FindsTheEventsOfOcclusions) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  for (const int rays : {1, 4}) {
    EventOptions options = adaptive_options();
    options.samples_per_pixel = rays;
    EventCamera exact(scene, motion, plane.camera, options);
    AdaptiveCamera sampled(scene, motion, plane.camera, options);
    const SensedEvents truth = record(exact, plane.duration_s);
    const auto [precision, recall] =
        compare(truth, record(sampled, plane.duration_s), plane.camera.width, plane.camera.height);
    EXPECT_GT(truth.size(), 3000U);
    EXPECT_GT(precision, 0.995) << rays;
    EXPECT_GT(recall, 0.995) << rays;
  }
}

// What is audited is a part; its intervals hold the whole's values.
TEST(AdaptiveCamera, TheAuditTellsWhatAFullComparisonTells) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  EventOptions options = adaptive_options();
  options.max_step_px = 2;  // makes errors to be measured
  options.audit_fraction = 0.3;
  EventCamera exact(scene, motion, plane.camera, options);
  AdaptiveCamera sampled(scene, motion, plane.camera, options);
  const auto [precision, recall] =
      compare(record(exact, plane.duration_s), record(sampled, plane.duration_s),
              plane.camera.width, plane.camera.height);
  const AuditResult audit = sampled.audit();
  EXPECT_GE(audit.pixels, 0.3 * 48 * 36);
  EXPECT_LE(audit.pixels, 0.4 * 48 * 36);
  EXPECT_LE(audit.precision_10us.low, precision);
  EXPECT_GE(audit.precision_10us.high, precision);
  EXPECT_LE(audit.recall_10us.low, recall);
  EXPECT_GE(audit.recall_10us.high, recall);
  EXPECT_LE(audit.precision_1us.value, audit.precision_10us.value);
}

TEST(AdaptiveCamera, AnAuditOfAllPixelsIsTheFullComparison) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  EventOptions options = adaptive_options();
  options.max_step_px = 2;
  options.audit_fraction = 1;
  EventCamera exact(scene, motion, plane.camera, options);
  AdaptiveCamera sampled(scene, motion, plane.camera, options);
  const SensedEvents truth = record(exact, plane.duration_s);
  const SensedEvents found = record(sampled, plane.duration_s);
  const auto [precision, recall] = compare(truth, found, plane.camera.width, plane.camera.height);
  const AuditResult audit = sampled.audit();
  EXPECT_EQ(audit.pixels, 48U * 36U);
  // A recording leaves out what falls on its very end.
  EXPECT_NEAR(audit.precision_10us.value, precision, 1e-3);
  EXPECT_NEAR(audit.recall_10us.value, recall, 1e-3);
}

TEST(AdaptiveCamera, WithoutAnAuditNothingIsAudited) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  EventOptions options = adaptive_options();
  options.audit_fraction = 0;
  AdaptiveCamera sampled(scene, motion, plane.camera, options);
  EXPECT_GT(record(sampled, plane.duration_s).size(), 3000U);
  EXPECT_EQ(sampled.audit().pixels, 0U);
}

TEST(AdaptiveCamera, FollowsTheModelsOfNoise) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  EventOptions options = noisy_options();
  options.noise.latency = {};  // of each event its own
  options.noise.readout = {};
  // The exact low pass is given lines within 1e-3 log units, which is more than 10 us of a slow ramp.
  options.noise.bandwidth = {};
  EventCamera exact(scene, motion, plane.camera, options);
  AdaptiveCamera sampled(scene, motion, plane.camera, options);
  const SensedEvents truth = record(exact, plane.duration_s);
  const auto [precision, recall] =
      compare(truth, record(sampled, plane.duration_s), plane.camera.width, plane.camera.height);
  EXPECT_GT(truth.size(), 2000U);
  EXPECT_GT(precision, 0.98);
  EXPECT_GT(recall, 0.98);
}

class AdaptiveCameraThreads : public ::testing::Test {
 protected:
  ~AdaptiveCameraThreads() override { set_thread_count(0); }
};

TEST_F(AdaptiveCameraThreads, DoNotChangeTheStream) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  set_thread_count(1);
  AdaptiveCamera alone(scene, motion, plane.camera, noisy_options());
  const SensedEvents expected = record(alone, plane.duration_s);
  EXPECT_GT(expected.size(), 1000U);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    AdaptiveCamera camera(scene, motion, plane.camera, noisy_options());
    EXPECT_EQ(record(camera, plane.duration_s), expected) << threads;
    EXPECT_EQ(camera.audit().recall_10us.low, alone.audit().recall_10us.low);
  }
}

TEST(AdaptiveCamera, ResumesToTheSameStreamAndAudit) {
  const ClosedFormPlane plane = moving_plane();
  const Scene scene = cards(plane);
  const Spline motion = plane.motion();
  for (const EventOptions& options : {adaptive_options(), noisy_options()}) {
    SensedEvents afterwards;
    std::string state;
    AdaptiveCamera whole(scene, motion, plane.camera, options);
    whole.record(plane.duration_s, [&](std::span<const SensedEvent> events, double t_s) {
      if (!state.empty()) afterwards.insert(afterwards.end(), events.begin(), events.end());
      if (state.empty() && t_s > 0.08) state = whole.state();
    });
    AdaptiveCamera second(scene, motion, plane.camera, options);
    second.resume(state);
    EXPECT_GT(afterwards.size(), 100U);
    EXPECT_EQ(record(second, plane.duration_s), afterwards);
    EXPECT_EQ(second.audit().exact_events, whole.audit().exact_events);
    EXPECT_EQ(second.audit().recall_1us.value, whole.audit().recall_1us.value);
    AdaptiveCamera third(scene, motion, plane.camera, options);
    EXPECT_THROW(third.resume(state.substr(0, state.size() - 1)), InputError);
    EXPECT_THROW(third.resume(state + "x"), InputError);
  }
}

TEST(ChosenSampling, AutoIsExactForUnlitScenes) {
  const Scene scene = testing::scene_of(moving_plane());
  EXPECT_EQ(chosen_sampling(Sampling::kAuto, scene), Sampling::kExact);
  EXPECT_EQ(chosen_sampling(Sampling::kAdaptive, scene), Sampling::kAdaptive);
  EXPECT_EQ(chosen_sampling(Sampling::kFrames, scene), Sampling::kFrames);
}

}  // namespace
}  // namespace saccade
