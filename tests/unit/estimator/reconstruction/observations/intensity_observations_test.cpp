#include "estimator/reconstruction/observations/intensity_observations.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

namespace saccade {
namespace {

TEST(SurfaceObservations, ConstrainsPixelsWithoutEventsInTurn) {
  const PinholeCamera camera{24, 18, 20, 20, 11.5, 8.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera&, ImageF& inverse) { inverse.fill(1); };
  const ImageF reference(24, 18, 1);
  // 4 px of motion along x in 0.1 s, and one event at each end.
  const Trajectory motion(
      {{0, Rigid3()}, {0.1, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.2, 0, 0))}});
  Events events;
  for (int i = 0; i <= 4096; ++i) events.push_back({i * 100'000'000LL / 4096, 0, 0, 1});
  for (const int stride : {1, 3}) {
    ObservationOptions options;
    options.no_event_spacing_px = 0.5;
    options.reprojection.redraw_motion_px = 1;
    options.no_event_stride = stride;
    SurfaceObservations source(camera, scene, Rigid3(), reference, {0.2, 0.2}, options);
    std::vector<IntensityObservation> observations;
    source.observe(events, motion, observations);
    std::set<std::uint32_t> runs;
    int constraints = 0;
    for (const IntensityObservation& observation : observations) {
      const float slack = source.kinds()[observation.kind()].slack;
      if (slack == 0) continue;
      runs.insert(observation.run());
      ++constraints;
      EXPECT_FLOAT_EQ(slack, 0.2F);
    }
    // 8 constraints by each of the 20 to 24 columns of 18 pixels that stay in the view, give or take one.
    EXPECT_NEAR(constraints * stride, 22 * 18 * 8, 22 * 18 * 8 / 5) << stride;
    EXPECT_GE(runs.size(), 20U * 18U) << stride;
  }
}

TEST(SurfaceObservations, TheFirstEventIsAThresholdFromWhatThePixelSawAtTheStart) {
  const PinholeCamera camera{24, 18, 20, 20, 11.5, 8.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera&, ImageF& inverse) { inverse.fill(1); };
  const ImageF reference(24, 18, 1);
  const Trajectory motion(
      {{0, Rigid3()}, {0.1, Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.2, 0, 0))}});
  const Events events{{0, 1, 1, 1}, {50'000'000, 12, 9, -1}, {100'000'000, 12, 9, -1}};
  ObservationOptions options;
  options.no_event_constraints = false;
  options.first_event_sigma = 0.8;
  SurfaceObservations source(camera, scene, Rigid3(), reference, {0.2, 0.3}, options);
  std::vector<IntensityObservation> observations;
  source.observe(events, motion, observations);
  // Of the first pixel two, of the other three, its start at its place before the motion.
  ASSERT_EQ(observations.size(), 5U);
  const IntensityObservation& start = observations[2];
  EXPECT_FLOAT_EQ(start.x, 12);
  EXPECT_FLOAT_EQ(start.y, 9);
  EXPECT_FLOAT_EQ(start.log_intensity, 0);
  EXPECT_FLOAT_EQ(source.kinds()[start.kind()].sigma, 0.8F * 0.25F);
  EXPECT_NEAR(observations[3].x, 14, 0.01);
  EXPECT_FLOAT_EQ(observations[3].log_intensity, -0.3F);
  EXPECT_EQ(observations[3].run(), start.run());
  EXPECT_FLOAT_EQ(observations[4].log_intensity, -0.6F);
}

TEST(SurfaceObservations, LeakingPixelsBeginAboveTheirReferences) {
  const PinholeCamera camera{96, 72, 80, 80, 47.5, 35.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera&, ImageF& inverse) { inverse.fill(1); };
  const ImageF reference(96, 72, 1);
  const Trajectory motion({{0, Rigid3()}, {0.1, Rigid3()}});
  // Nine of ten pixels rise, all after 1 ms, and stay so.
  Events events{{0, 0, 0, 1}};
  for (std::uint16_t y = 0; y < 72; ++y)
    for (std::uint16_t x = 0; x < 96; ++x)
      if (x + y > 0)
        events.push_back({1'000'000, x, y, std::int8_t((x + 3 * y) % 10 == 0 ? -1 : 1)});
  events.push_back({100'000'000, 0, 0, 1});
  ObservationOptions options;
  options.no_event_constraints = false;
  options.first_event_sigma = 0.8;
  options.expected_fraction = 0.4;
  for (const bool removes : {false, true}) {
    options.remove_bias = removes;
    SurfaceObservations source(camera, scene, Rigid3(), reference, {0.2, 0.2}, options);
    std::vector<IntensityObservation> observations;
    source.plan(events);
    source.observe(events, motion, observations);
    // The second pixel: its start, and a threshold above its reference.
    const IntensityObservation& start = observations[2];
    EXPECT_NEAR(start.log_intensity, removes ? 0.8 * 0.2 : 0, 0.005);
    EXPECT_FLOAT_EQ(observations[3].log_intensity, 0.2F);
    EXPECT_EQ(observations[3].run(), start.run());
    // Beyond nine last events that are ON and one that is OFF the log intensity is the same in the mean.
    std::vector<float> expected;
    for (const ObservationKind& kind : source.kinds())
      if (kind.expected != 0) expected.push_back(kind.expected);
    ASSERT_EQ(expected.size(), 2U);
    EXPECT_NEAR(expected[0], removes ? 0.2 * 0.4 * 0.2 : 0.4 * 0.2, 0.002);
    EXPECT_NEAR(expected[1], removes ? -1.8 * 0.4 * 0.2 : -0.4 * 0.2, 0.002);
  }
}

}  // namespace
}  // namespace saccade
