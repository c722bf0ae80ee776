#include "estimator/depth/rays/stream_delay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/depth/rays/ray_depth.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_glide;
using testing::corner_world;
using testing::Motion;
using testing::PlanarWorld;
using testing::trajectory_of;

constexpr double kShakeEnd_s = 0.3;
constexpr double kShakeMiddle_s = kShakeEnd_s / 2;

/// To and fro by 6 px, little more than once, while the camera climbs.
Rigid3 shake(double t_s) {
  return {Eigen::Quaterniond::Identity(), {0.1 * std::sin(25 * t_s), 0.2 * t_s, 0}};
}

/// Sideways by 12 px, ever more slowly, and back a little: a delay is taken for depth.
Rigid3 slow_down(double t_s) {
  return {Eigen::Quaterniond::Identity(), {0.2 * std::sin(7 * t_s), 0.2 * t_s, 0}};
}

const PlanarWorld& shaken_world() {
  static const PlanarWorld world = corner_world(160, 120);
  return world;
}

Events events_of(const Motion& motion, TimeNs delay_ns) {
  Events events = shaken_world().simulate(motion, 0, kShakeEnd_s, 1e-3, 0.15);
  for (Event& event : events) event.t_ns += delay_ns;
  return events;
}

DepthResult depth_of(const Events& events, const Motion& motion, bool find_delay) {
  const Trajectory poses = trajectory_of(motion, kShakeEnd_s + 0.01);
  RayDepthOptions options;
  options.find_delay = find_delay;
  return RayDepth(options, {}, shaken_world().camera()).estimate({events, &poses, kShakeMiddle_s});
}

/// Of the depth, in the median.
double relative_error(const DepthResult& result, const Motion& motion) {
  const ImageF truth = shaken_world().depth(motion(kShakeMiddle_s));
  std::vector<double> errors;
  for (const EdgePoint& point : result.points) {
    const auto x = static_cast<int>(std::lround(point.x_px)),
               y = static_cast<int>(std::lround(point.y_px));
    if (x >= 0 && y >= 0 && x < truth.width() && y < truth.height() && truth(x, y) > 0)
      errors.push_back(std::abs(1 / static_cast<double>(point.inverse_depth * truth(x, y)) - 1));
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

/// As if the clock of the events went after by `delay_ns`, or before if that is negative.
Events shifted(const Motion& motion, TimeNs delay_ns) {
  Events events = events_of(motion, delay_ns);
  // Nothing may come before the time of the poses.
  std::erase_if(events, [](const Event& event) { return event.t_ns < 0; });
  return events;
}

TEST(StreamDelay, IsFound) {
  for (const TimeNs delay_ns : {TimeNs{2'000'000}, TimeNs{800'000}, TimeNs{-1'500'000}}) {
    const Events events = shifted(shake, delay_ns);
    EXPECT_EQ(depth_of(events, shake, false).event_delay_s, 0);
    EXPECT_NEAR(depth_of(events, shake, true).event_delay_s, 1e-9 * static_cast<double>(delay_ns),
                0.15e-9 * static_cast<double>(std::abs(delay_ns)));
  }
}

TEST(StreamDelay, IsTakenOutOfTheDepth) {
  for (const TimeNs delay_ns : {TimeNs{2'000'000}, TimeNs{-1'500'000}}) {
    const Events events = shifted(slow_down, delay_ns);
    const DepthResult with = depth_of(events, slow_down, true);
    ASSERT_GT(with.points.size(), 200U);
    EXPECT_LT(relative_error(with, slow_down),
              0.6 * relative_error(depth_of(events, slow_down, false), slow_down));
  }
}

// A path that is still to be adjusted has errors that look like one.
TEST(StreamDelay, IsNotSoughtForEdgelsThatAdjustThePath) {
  const Events events = shifted(shake, 2'000'000);
  const Trajectory poses = trajectory_of(shake, kShakeEnd_s + 0.01);
  const ViewWindow window{events, &poses, kShakeMiddle_s};
  const RayDepth depth({}, {}, shaken_world().camera());
  EXPECT_EQ(depth.find_edgels(window).delay.delay_s, 0);
  EXPECT_NEAR(depth.find_delayed_edgels(window).delay.delay_s, 2e-3, 3e-4);
}

TEST(StreamDelay, IsNoneWhereEventsComeInTime) {
  const DepthResult result = depth_of(events_of(shake, 0), shake, true);
  EXPECT_LT(std::abs(result.event_delay_s), 5e-5);
}

// A delay is then like another place of the edge.
TEST(StreamDelay, IsNotToldByUniformMotion) {
  const Motion slide = [](double t_s) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.9 * t_s, 0.25 * t_s, 0));
  };
  EXPECT_EQ(depth_of(events_of(slide, 500'000), slide, true).event_delay_s, 0);
}

TEST(StreamDelay, IsWeighedAgainstWhatIsKnownBeforehand) {
  EXPECT_NEAR((StreamDelay{8e-4, 1e-5}).with_prior().delay_s, 8e-4, 1e-6);
  const StreamDelay half = StreamDelay{8e-4, 0.999e-3}.with_prior();
  EXPECT_NEAR(half.delay_s, 4e-4, 1e-6);
  EXPECT_NEAR(half.sigma_s, 1e-3 / std::sqrt(2.0), 1e-6);
  EXPECT_EQ((StreamDelay{8e-3, 2e-3}).with_prior().delay_s, 0);
}

TEST(StreamDelay, OfNoEdgelsIsNotKnown) {
  const Trajectory poses = trajectory_of(shake, kShakeEnd_s);
  const UndistortionTable undistortion(shaken_world().camera());
  const EventRays rays({{}, &poses, kShakeMiddle_s}, shaken_world().camera(), undistortion, 24);
  const StreamDelay none = estimate_delay(rays, {}, {}, {});
  EXPECT_EQ(none.delay_s, 0);
  EXPECT_TRUE(std::isinf(none.sigma_s));
}

}  // namespace
}  // namespace saccade
