#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/event_source.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/frame_camera.h"
#include "simulator/simulation_config.h"
#include "tests/support/brute_force.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/animation/animated_scenes.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;

class AnimatedEvents : public testing::AnimatedFiles {
 protected:
  ~AnimatedEvents() override { set_thread_count(0); }
};

template <class Camera>
Events events_recorded(Camera& camera, double duration_s) {
  Events all;
  camera.record(duration_s, [&](std::span<const SensedEvent> events, double) {
    for (const SensedEvent& event : events) all.push_back(event.event());
  });
  return all;
}

EventOptions options_of(double contrast) {
  EventOptions options = testing::in_nanoseconds();
  options.sampling = Sampling::kAdaptive;
  options.contrast = {contrast, contrast};
  return options;
}

/// The turning square as a pixel sees it, from_axis in metres.
struct TurningAlbedo {
  Eigen::Vector2d from_axis;

  [[nodiscard]] double angle(double t_s) const {
    return std::atan2(from_axis.y(), from_axis.x()) - pi * t_s;
  }
  [[nodiscard]] double albedo(double t_s) const {
    return 0.4 + 0.4 * from_axis.norm() * std::cos(angle(t_s));
  }
  [[nodiscard]] double albedo_rate(double t_s) const {
    return 0.4 * from_axis.norm() * pi * std::sin(angle(t_s));
  }
};

/// Times and polarities of the events of a signal, by bisection from a fine grid.
std::vector<std::pair<double, int>> events_of(const TurningAlbedo& pixel, double contrast,
                                              double log_eps, double duration_s) {
  const auto signal = [&](double t_s) { return std::log(log_eps + pixel.albedo(t_s)); };
  std::vector<std::pair<double, int>> events;
  double reference = signal(0);
  constexpr double kStep_s = 1e-4;
  for (double t_s = 0; t_s < duration_s; t_s += kStep_s) {
    const double end_s = std::min(t_s + kStep_s, duration_s);
    const double change = signal(end_s) - reference;
    if (std::abs(change) < contrast) continue;
    const int polarity = change > 0 ? 1 : -1;
    double low = t_s, high = end_s;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (polarity * (signal(middle) - reference) < contrast ? low : high) = middle;
    }
    events.emplace_back(high, polarity);
    reference += polarity * contrast;
  }
  return events;
}

TEST_F(AnimatedEvents, ComeAtTheTimesOfTheClosedForm) {
  const PinholeCamera camera{32, 32, 60, 60, 15.5, 15.5, {}};
  constexpr double kDuration_s = 0.4;
  const EventOptions options = options_of(0.05);
  const Spline motion = testing::resting_above({0, 0}, kDuration_s);
  for (const bool on_bone : {false, true}) {
    const Scene scene = this->scene(testing::turning_square(on_bone));
    AdaptiveCamera recorder(scene, motion, camera, options);
    std::map<std::pair<int, int>, Events> found;
    for (const Event& event : events_recorded(recorder, kDuration_s))
      found[{event.x, event.y}].push_back(event);
    std::size_t expected_count = 0, late = 0, extra = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const TurningAlbedo pixel{Eigen::Vector2d(x - 15.5, 15.5 - y) / 30};
        if (pixel.from_axis.norm() > 0.48) continue;
        const auto expected = events_of(pixel, 0.05, options.log_eps, kDuration_s);
        const Events& own = found[{x, y}];
        expected_count += expected.size();
        extra += own.size() > expected.size() ? own.size() - expected.size() : 0;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          // The chords are within 2.9e-5 m of the arcs, and the reference counts twice.
          const double error_s =
              1e-6 + 2 * 0.4 * 2.9e-5 / std::abs(pixel.albedo_rate(expected[k].first));
          if (k >= own.size() || own[k].polarity != expected[k].second ||
              std::abs(seconds_from_ns(own[k].t_ns) - expected[k].first) > error_s)
            ++late;
        }
      }
    EXPECT_GT(expected_count, 1000U);
    EXPECT_EQ(extra, 0U) << on_bone;
    EXPECT_LE(late, expected_count / 1000) << on_bone;
  }
}

/// The strip on bones before a grey floor, in view of a camera that moves.
class AnimatedStrip : public AnimatedEvents {
 protected:
  static constexpr double kDuration_s = 0.08;

  [[nodiscard]] static Spline motion() {
    std::vector<StampedPose> poses;
    for (int k = 0; k <= 8; ++k) {
      const Rigid3 pose = testing::from_above({1.2 + 0.02 * k, 0.01 * k * k / 8.0});
      poses.push_back({0.01 * k, pose});
    }
    return Spline::interpolate(poses);
  }
  [[nodiscard]] Scene strip() const {
    write("floor.obj",
          "mtllib floor.mtl\nusemtl f\nv -3 -3 -0.5\nv 4 -3 -0.5\nv 4 4 -0.5\nv -3 4 -0.5\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
    write("floor.mtl", "newmtl f\nKd 0.4 0.4 0.4\n");
    return scene(testing::strip_on_bones(), "animation: {start_s: -0.1}",
                 "  - {file: floor.obj}\nbackground: 0.1\n");
  }
  PinholeCamera camera_{24, 20, 20, 20, 11.5, 9.5, {}};
};

TEST_F(AnimatedStrip, EventsAreThoseOfBruteForce) {
  const Scene scene = strip();
  EventOptions options = options_of(0.04);
  options.max_step_px = 0.1;  // at 0.5 a tip of the strip passes a pixel unseen, within 0.04 px
  const Spline path = motion();
  const Events truth = testing::brute_force(scene, path, camera_, options);
  AdaptiveCamera recorder(scene, path, camera_, options);
  const Events found = events_recorded(recorder, kDuration_s);
  ASSERT_GT(truth.size(), 300U);
  const auto pairs = static_cast<double>(testing::count_pairs(truth, found, 10'000));
  EXPECT_GT(pairs / static_cast<double>(truth.size()), 0.985);
  EXPECT_GT(pairs / static_cast<double>(found.size()), 0.985);
}

TEST_F(AnimatedStrip, FramesComeCloser) {
  const Scene scene = strip();
  EventOptions options = options_of(0.04);
  options.sampling = Sampling::kFrames;
  options.frames_lambda_px = 0.05;
  const Spline path = motion();
  FrameCamera recorder(scene, path, camera_, options);
  const Events found = events_recorded(recorder, kDuration_s);
  const Events truth = testing::brute_force(scene, path, camera_, options);
  EXPECT_GT(static_cast<double>(testing::count_pairs(truth, found, 2'000'000)),
            0.95 * static_cast<double>(truth.size()));
}

TEST_F(AnimatedStrip, FramesFollowADeformationBeforeACameraAtRest) {
  const Scene scene = strip();
  EventOptions options = options_of(0.04);
  options.sampling = Sampling::kFrames;
  const Spline rest = testing::resting_above({1.2, 0}, kDuration_s);
  FrameCamera recorder(scene, rest, camera_, options);
  static_cast<void>(events_recorded(recorder, kDuration_s));
  // The tip moves with pi m/s, 31 px/s: half a pixel takes 16 ms, a frame 10 ms at most.
  EXPECT_LE(recorder.statistics().time_bound_s, 0.01 + 1e-9);
  EXPECT_GT(recorder.statistics().rays, 8U * 24 * 20);
}

// Also what is missed: a tip of the strip that passes a pixel unseen.
TEST_F(AnimatedStrip, TheDenseAuditTellsWhatBruteForceTells) {
  const Scene scene = strip();
  EXPECT_EQ(audit_reference(scene), AuditReference::kDense);
  EventOptions options = options_of(0.04);
  options.audit_fraction = 1;
  const Spline path = motion();
  AdaptiveCamera recorder(scene, path, camera_, options);
  const Events found = events_recorded(recorder, kDuration_s);
  const AuditResult audit = recorder.audit();
  EXPECT_EQ(audit.pixels, 24U * 20);
  EXPECT_EQ(audit.sampled_events, found.size());
  EXPECT_GT(audit.exact_events, 300U);
  const Events truth = testing::brute_force(scene, path, camera_, options);
  const auto pairs = static_cast<double>(testing::count_pairs(truth, found, 10'000));
  EXPECT_NEAR(audit.recall_10us.value, pairs / static_cast<double>(truth.size()), 0.01);
  EXPECT_NEAR(audit.precision_10us.value, pairs / static_cast<double>(found.size()), 0.01);
  EXPECT_GT(audit.recall_10us.value, 0.93);
  EXPECT_GT(audit.precision_10us.value, 0.98);
}

TEST_F(AnimatedStrip, ThreadsDoNotChangeTheStreamOrTheAudit) {
  const Scene scene = strip();
  const Spline path = motion();
  const EventOptions options = options_of(0.04);
  set_thread_count(1);
  AdaptiveCamera alone(scene, path, camera_, options);
  const Events expected = events_recorded(alone, kDuration_s);
  for (const int threads : {2, 4}) {
    set_thread_count(threads);
    AdaptiveCamera camera(scene, path, camera_, options);
    EXPECT_EQ(events_recorded(camera, kDuration_s), expected) << threads;
    EXPECT_EQ(camera.audit().recall_10us.low, alone.audit().recall_10us.low);
  }
}

TEST_F(AnimatedStrip, ResumesToTheSameStreamAndAudit) {
  const Scene scene = strip();
  const Spline path = motion();
  const EventOptions options = options_of(0.04);
  Events afterwards;
  std::string state;
  AdaptiveCamera whole(scene, path, camera_, options);
  whole.record(kDuration_s, [&](std::span<const SensedEvent> events, double t_s) {
    if (!state.empty())
      for (const SensedEvent& event : events) afterwards.push_back(event.event());
    if (state.empty() && t_s > 0.03) state = whole.state();
  });
  AdaptiveCamera second(scene, path, camera_, options);
  second.resume(state);
  EXPECT_GT(afterwards.size(), 50U);
  EXPECT_EQ(events_recorded(second, kDuration_s), afterwards);
  EXPECT_EQ(second.audit().exact_events, whole.audit().exact_events);
  EXPECT_EQ(second.audit().recall_1us.value, whole.audit().recall_1us.value);
}

TEST_F(AnimatedStrip, ExactSamplingIsAnErrorThatNamesAdaptive) {
  const Scene scene = strip();
  EXPECT_EQ(chosen_sampling(Sampling::kAuto, scene), Sampling::kAdaptive);
  EXPECT_EQ(sampling_reason(Sampling::kAuto, scene), "animated meshes");
  EXPECT_EQ(chosen_sampling(Sampling::kFrames, scene), Sampling::kFrames);
  EXPECT_THAT(
      testing::error_of([&] { static_cast<void>(chosen_sampling(Sampling::kExact, scene)); }),
      AllOf(HasSubstr("events.sampling"), HasSubstr("adaptive")));
}

TEST_F(AnimatedStrip, AConfigurationSaysSoWithItsPlace) {
  write("model.gltf", testing::strip_on_bones().text());
  const auto read = [&](const std::string& sampling) {
    return config::read<SimulationConfig>(
        config::parse("scene: {meshes: [{file: model.gltf, animation: {loop: true}}]}\n"
                      "trajectory: {source: shake}\n"
                      "events: {sampling: " +
                          sampling + "}\n",
                      "walk.yaml", folder_));
  };
  EXPECT_THAT(testing::error_of([&] { static_cast<void>(read("exact")); }),
              AllOf(HasSubstr("walk.yaml:3"), HasSubstr("adaptive")));
  EXPECT_TRUE(read("auto").scene.meshes[0].animation->loop);
}

}  // namespace
}  // namespace saccade
