#include "estimator/reconstruction/observations/intensity_observations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/depth_mesh.h"
#include "core/random.h"
#include "core/rigid3.h"
#include "tests/support/intensity_observations.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::PlanarWorld;

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
    const auto observations = testing::observations_of(source, events, motion, 1);
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

/// Poses that jump by 10 px at once, as of motion capture that lost its markers: no constraint for every half pixel of it.
TEST(SurfaceObservations, AJumpOfThePosesIsNoMotion) {
  const PinholeCamera camera{24, 18, 20, 20, 11.5, 8.5, {}};
  DepthScene scene;
  scene.draw = [](const Rigid3&, const PinholeCamera&, ImageF& inverse) { inverse.fill(1); };
  const ImageF reference(24, 18, 1);
  const Rigid3 aside(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.5, 0, 0));
  const Trajectory motion({{0, Rigid3()}, {0.05, Rigid3()}, {0.05001, aside}, {0.1, aside}});
  const Events events{
      {0, 1, 1, 1}, {50'000'000, 1, 1, 1}, {50'010'000, 1, 1, 1}, {100'000'000, 1, 1, 1}};
  ObservationOptions options;
  options.no_event_spacing_px = 0.5;
  SurfaceObservations source(camera, scene, Rigid3(), reference, {0.2, 0.2}, options);
  const auto observations = testing::observations_of(source, events, motion, 1);
  EXPECT_GT(observations.size(), 24U * 18U);  // the first ones
  EXPECT_LT(observations.size(), 6U * 24U * 18U);
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
  const auto observations = testing::observations_of(source, events, motion, 1);
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
    const auto observations = testing::observations_of(source, events, motion, 1);
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

/// However long there is no event: the motion meanwhile is not held in memory, but constrained all the same.
TEST(SurfaceObservations, FewEventsInALongTimeConstrainAllOfIt) {
  const PinholeCamera camera{24, 18, 20, 20, 11.5, 8.5, {}};
  std::size_t pictures = 0;
  DepthScene scene;
  scene.draw = [&](const Rigid3&, const PinholeCamera&, ImageF& inverse) {
    inverse.fill(1);
    ++pictures;
  };
  const ImageF reference(24, 18, 1);
  // Swings of 6 px to either side, 24 px in 0.5 s.
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 2000; ++i) {
    const double t_s = i * 0.01;
    poses.push_back(
        {t_s, Rigid3(Eigen::Quaterniond::Identity(),
                     Eigen::Vector3d(0.3 * std::sin(4 * std::numbers::pi * t_s), 0, 0))});
  }
  const Trajectory motion(std::move(poses));
  const Events events{{0, 12, 9, 1}, {20'000'000'000, 12, 9, 1}};
  ObservationOptions options;
  options.no_event_spacing_px = 1;
  options.reprojection.redraw_motion_px = 2;
  SurfaceObservations source(camera, scene, Rigid3(), reference, {0.2, 0.2}, options);
  const auto observations = testing::observations_of(source, events, motion, 3);
  EXPECT_GT(pictures, 300U);  // of many batches
  // 960 px of motion, 17 of 24 columns in the mean.
  EXPECT_NEAR(static_cast<double>(observations.size()), 960.0 * 18 * 20, 960.0 * 18 * 4);
}

/// The paths of a panorama's pixels go on across its seam, in each band by itself.
TEST(PanoramaObservations, AreThoseOfTheWholeSensorInBands) {
  const PinholeCamera camera{40, 30, 40, 40, 19.5, 14.5, {}};
  const Panorama panorama{256, 0, 44, 256, 40};
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i)
    poses.push_back({i * 1e-2, Rigid3(so3_exp({0, 0.07 * i, 0}), Eigen::Vector3d::Zero())});
  const Trajectory motion(std::move(poses));
  const Random random(5);
  Events events;
  for (std::uint64_t i = 0; i < 100'000; ++i)
    events.push_back({static_cast<TimeNs>(i) * 10'000,
                      static_cast<std::uint16_t>(random.below(40, 1, i)),
                      static_cast<std::uint16_t>(random.below(30, 2, i)),
                      static_cast<std::int8_t>(random.below(2, 3, i) == 0 ? -1 : 1)});
  const auto sorted = [&](std::size_t bands) {
    PanoramaObservations source(camera, panorama, {0.2, 0.2}, {});
    std::vector<std::array<float, 4>> all;
    for (const IntensityObservation& o : testing::observations_of(source, events, motion, bands))
      all.push_back({o.x, o.y, o.log_intensity, static_cast<float>(o.kind())});
    std::sort(all.begin(), all.end());
    return all;
  };
  const auto whole = sorted(1);
  EXPECT_GT(whole.size(), events.size() / 2);
  EXPECT_EQ(sorted(6), whole);
}

/// Bands of rows see what the whole sensor sees, pixel by pixel.
TEST(SurfaceObservations, AreThoseOfTheWholeSensorInBands) {
  const PlanarWorld world = testing::corner_world(120, 90);
  const Events events = world.simulate(corner_motion, 0, 0.1, 1e-3, 0.2);
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back({i * 1e-3, corner_motion(i * 1e-3)});
  const Trajectory motion(std::move(poses));
  const DepthMesh mesh(world.depth(corner_motion(0)), world.camera());
  DepthScene scene;
  scene.draw = [&](const Rigid3& camera_from_world, const PinholeCamera& target, ImageF& inverse) {
    mesh.draw(camera_from_world * corner_motion(0), target, inverse);
  };
  ImageF reference(120, 90);
  scene.draw(corner_motion(0).inverse(), world.camera(), reference);
  ObservationOptions options;
  options.no_event_spacing_px = 0.8;
  options.no_event_stride = 4;
  options.first_event_sigma = 0.8;
  const auto sorted = [&](std::size_t bands) {
    SurfaceObservations source(world.camera(), scene, corner_motion(0), reference, {0.2, 0.2},
                               options);
    std::vector<std::array<float, 4>> all;
    for (const IntensityObservation& o : testing::observations_of(source, events, motion, bands))
      all.push_back({o.x, o.y, o.log_intensity, static_cast<float>(o.kind())});
    std::sort(all.begin(), all.end());
    return all;
  };
  const auto whole = sorted(1);
  EXPECT_GT(whole.size(), events.size());
  EXPECT_EQ(sorted(7), whole);
  EXPECT_EQ(sorted(200), whole);  // more than rows
}

}  // namespace
}  // namespace saccade
