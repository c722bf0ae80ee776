#include "estimator/tracking/check/pose_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "core/time_search.h"
#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::resolved_recording;

const PinholeCamera& sensor() { return resolved_recording().world.camera(); }

const MapPoints& true_map() {
  static const MapPoints map = extract_map(resolved_recording().view.log_intensity,
                                           resolved_recording().view.depth, sensor(), MapOptions());
  return map;
}

/// Events up to a time, as many as the check wants; the map's frame is the view's.
struct Glance {
  PoseCheck check{sensor()};
  Rigid3 map_from_camera;

  explicit Glance(double t_s, const MapPoints& map = true_map())
      : map_from_camera(corner_motion(0).inverse() * corner_motion(t_s)) {
    check.set_map(map);
    const std::span<const Event> events = resolved_recording().events;
    const std::size_t end = count_until(events, ns_from_seconds(t_s)) + check.events() / 2;
    check.measure(events.subspan(end - check.events(), check.events()));
  }
};

double kappa(const PoseEvidence& evidence) {
  return (evidence.explained - evidence.chance) / (1 - evidence.chance);
}

TEST(PoseCheck, EventsLieOnTheMapUnderTheTruePose) {
  double seen = 0, confirmed_if_wrong = 0;
  for (const double t_s : {0.05, 0.12, 0.2}) {
    Glance glance(t_s);
    const PoseEvidence evidence = glance.check.evaluate(glance.map_from_camera);
    // Of some 900 events a fifth lies on the map by chance: kappa has a standard deviation of 0.017
    // if they are independent, and of 0.05 if one in nine is. Four of the latter.
    EXPECT_GT(kappa(evidence), 0.2) << t_s;
    EXPECT_GT(evidence.in_map, 0.7) << t_s;
    EXPECT_NEAR(evidence.depth_m, testing::kCornerDepth_m, 0.5) << t_s;
    seen += evidence.edges_confirmed;
    confirmed_if_wrong += evidence.confirmed_if_wrong;
  }
  // Even against the best of twelve wrong ones.
  EXPECT_GT(seen, confirmed_if_wrong);
}

TEST(PoseCheck, AtTheLimitsOfALossTheyLieThereByChance) {
  Glance glance(0.12);
  const PoseEvidence right = glance.check.evaluate(glance.map_from_camera);
  for (int axis = 0; axis < 6; ++axis)
    for (const double sign : {1.0, -1.0}) {
      // Twice the limits; forwards, which moves the middle of the image by little, four times: 20 %
      // of the depth moves a pixel by a quarter of its 50 px to the middle, six cells.
      const double size = axis == 2 ? 4 : 2;
      Twist displacement = Twist::Zero();
      displacement[axis] =
          size * sign * (axis < 3 ? kLossDepthRatio * right.depth_m : kLossAngle_rad);
      const PoseEvidence wrong =
          glance.check.evaluate(glance.map_from_camera * Rigid3::exp(displacement));
      EXPECT_LT(kappa(wrong), 0.6 * kappa(right)) << axis;
    }
}

TEST(PoseCheck, TheMapOfAnotherWorldExplainsNothing) {
  const ReferenceView& view = resolved_recording().view;
  ImageF mirrored = view.log_intensity;
  for (int y = 0; y < mirrored.height(); ++y)
    for (int x = 0; x < mirrored.width(); ++x)
      mirrored(x, y) = view.log_intensity(mirrored.width() - 1 - x, mirrored.height() - 1 - y);
  Glance glance(0.12, extract_map(mirrored, view.depth, sensor(), MapOptions()));
  const PoseEvidence evidence = glance.check.evaluate(glance.map_from_camera);
  EXPECT_GT(evidence.edges, 500);
  EXPECT_LT(kappa(evidence), 0.1);
}

TEST(PoseCheck, AFrameIsMeasuredByItsSteepPixels) {
  Glance glance(0.12);
  glance.check.measure(resolved_recording().world.log_intensity(corner_motion(0.12)));
  const PoseEvidence right = glance.check.evaluate(glance.map_from_camera);
  EXPECT_GT(kappa(right), 1.0 / 3);
  Twist turn = Twist::Zero();
  turn[4] = 2 * kLossAngle_rad;
  EXPECT_LT(kappa(glance.check.evaluate(glance.map_from_camera * Rigid3::exp(turn))), 0.1);
}

TEST(PoseCheck, WithoutAMapInViewOrAMeasurementThereIsNoEvidence) {
  Glance away(0.12);
  const Rigid3 turned(so3_exp({0, 3.1, 0}), {0, 0, 0});
  EXPECT_EQ(away.check.evaluate(turned), PoseEvidence{});
  PoseCheck blind(sensor());
  EXPECT_EQ(blind.evaluate(Rigid3()), PoseEvidence{});
  blind.set_map(true_map());
  blind.measure(std::span<const Event>());
  const PoseEvidence nothing = blind.evaluate(Rigid3());
  EXPECT_EQ(nothing.measured, 0);
  EXPECT_EQ(nothing.explained, nothing.chance);
  EXPECT_EQ(nothing.edges_confirmed, 0);
  // A picture that shows one grey has no steep pixels.
  blind.measure(ImageF(sensor().width, sensor().height, -1.0F));
  EXPECT_EQ(blind.evaluate(Rigid3()).measured, 0);
}

TEST(PoseCheck, EventsAreMovedToTheUndistortedSensor) {
  PinholeCamera lens = sensor();
  lens.distortion = {-0.3, 0.1, 0, 0, 0};
  Events distorted;
  const std::span<const Event> events = resolved_recording().events;
  const std::size_t end = count_until(events, ns_from_seconds(0.12));
  // Each event at the pixel of the lens that sees what its pixel does.
  const UndistortionTable table(lens);
  for (int y = 0; y < lens.height; ++y)
    for (int x = 0; x < lens.width; ++x) {
      const Eigen::Vector2f at = table(x, y);
      for (const Event& event : events.subspan(end - 1000, 1000))
        if (event.x == std::lround(at.x()) && event.y == std::lround(at.y()))
          distorted.push_back({event.t_ns, static_cast<std::uint16_t>(x),
                               static_cast<std::uint16_t>(y), event.polarity});
    }
  ASSERT_GT(distorted.size(), 500U);
  PoseCheck check(lens);
  check.set_map(true_map());
  check.measure(distorted);
  const Rigid3 pose = corner_motion(0).inverse() * corner_motion(0.12);
  EXPECT_GT(kappa(check.evaluate(pose)), 0.3);
}

}  // namespace
}  // namespace saccade
