#include "estimator/tracking/intensity/intensity_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::expect_equal;
using testing::expect_lost_but_finite;
using testing::kRecordedContrast;
using testing::resolved_errors;
using testing::resolved_recording;
using testing::tracking_config;
using Errors = testing::CornerRecording::Errors;

TrackConfig best() { return tracking_config("best"); }

double resolved_error_px(const TrackedPose& pose) { return resolved_recording().error_px(pose); }

/// The tracker with all that has to outlive it.
class IntensityTracking {
 public:
  explicit IntensityTracking(const TrackConfig& config = best(),
                             std::optional<double> contrast = kRecordedContrast,
                             const ReferenceView& view = resolved_recording().view)
      : map_(resolved_recording().world.camera(), std::span(&view, 1),
             config.intensity.map_blur_px),
        points_(extract_map(view.log_intensity, view.depth, map_.camera(), config.map)),
        edges_(testing::fallback_options(config), map_.camera(), points_, map_.world_from_map(),
               config.seed),
        tracker_(config.intensity, config.motion, both(contrast), map_.camera(), map_, edges_) {
    tracker_.reset(0, view.world_from_reference);
  }

  IntensityTracker& operator*() { return tracker_; }
  IntensityTracker* operator->() { return &tracker_; }

 private:
  static std::optional<EventContrast> both(const std::optional<double>& contrast) {
    return contrast ? std::optional(EventContrast{*contrast, *contrast}) : std::nullopt;
  }

  IntensityMap map_;
  MapPoints points_;
  EdgeTracker edges_;
  IntensityTracker tracker_;
};

/// The poses from a time on, all of which must be sure of themselves.
std::vector<TrackedPose> from(double start_s, const std::vector<TrackedPose>& poses) {
  std::vector<TrackedPose> later;
  for (const TrackedPose& pose : poses)
    if (seconds_from_ns(pose.t_ns) >= start_s) {
      EXPECT_EQ(pose.status, TrackStatus::kOk) << seconds_from_ns(pose.t_ns);
      later.push_back(pose);
    }
  EXPECT_GT(later.size(), 5U);
  return later;
}

Events without(double from_s, double to_s) {
  Events events;
  for (const Event& event : resolved_recording().events)
    if (seconds_from_ns(event.t_ns) < from_s || seconds_from_ns(event.t_ns) >= to_s)
      events.push_back(event);
  return events;
}

TEST(IntensityTracker, RecoversEveryPoseAndBeatsTheEdges) {
  IntensityTracking tracking;
  const Errors errors = resolved_errors(from(0, tracking->track({resolved_recording().events})));
  EXPECT_LT(errors.mean, 0.09);
  EXPECT_LT(errors.largest, 0.6);

  const TrackConfig edges = tracking_config("accurate");
  const ReferenceView& view = resolved_recording().view;
  const PinholeCamera& camera = resolved_recording().world.camera();
  const MapPoints points = extract_map(view.log_intensity, view.depth, camera, edges.map);
  EdgeTracker tracker(edges.edges, camera, points, view.world_from_reference, 1);
  tracker.reset(0, view.world_from_reference);
  const Errors by_edges = resolved_errors(tracker.track({resolved_recording().events}));
  EXPECT_LT(3 * errors.mean, by_edges.mean);
}

TEST(IntensityTracker, FindsThresholdsThatNobodyStates) {
  IntensityTracking tracking(best(), std::nullopt);
  const Errors errors = resolved_errors(tracking->track({resolved_recording().events}));
  EXPECT_LT(errors.mean, 0.15);
  ASSERT_TRUE(tracking->found_contrast());
  EXPECT_NEAR(tracking->found_contrast()->on, kRecordedContrast, 0.3 * kRecordedContrast);
  EXPECT_NEAR(tracking->found_contrast()->off, kRecordedContrast, 0.3 * kRecordedContrast);
  EXPECT_FALSE(IntensityTracking()->found_contrast());
}

TEST(IntensityTracker, PosesFollowOneAnotherInTime) {
  IntensityTracking tracking;
  std::size_t done = 0;
  const auto poses =
      tracking->track({resolved_recording().events}, [&](std::size_t n) { done += n; });
  EXPECT_GT(poses.size(), resolved_recording().events.size() / 10000);
  EXPECT_LE(done, resolved_recording().events.size());
  TimeNs last = -1;
  for (const TrackedPose& pose : poses) {
    EXPECT_GE(pose.first_ns, last);
    EXPECT_LE(pose.first_ns, pose.t_ns);
    EXPECT_LE(pose.t_ns, pose.last_ns);
    EXPECT_GT(pose.inlier_ratio, 0.5);
    EXPECT_LE(pose.inlier_ratio, 1);
    EXPECT_GT(pose.residual, 0.005);
    EXPECT_LT(pose.residual, 0.3) << "of events 0.15 apart";
    last = pose.last_ns;
  }
}

TEST(IntensityTracker, RepeatsItsBits) {
  const Events gap = without(0.1, 0.15);
  for (const Events* events : {&resolved_recording().events, &gap}) {
    IntensityTracking tracking;
    const auto first = tracking->track({*events});
    IntensityTracking other;
    expect_equal(first, other->track({*events}));
    tracking->reset(0, corner_motion(0));
    expect_equal(first, tracking->track({*events}));
  }
}

TEST(IntensityTracker, DoesNotDependOnWhereTheWorldBegins) {
  const Rigid3 elsewhere(so3_exp({0.5, -1, 2}), {100, -20, 3});
  ReferenceView moved = resolved_recording().view;
  moved.world_from_reference = elsewhere * corner_motion(0);
  IntensityTracking here;
  IntensityTracking there(best(), kRecordedContrast, moved);
  const auto a = here->track({resolved_recording().events});
  const auto b = there->track({resolved_recording().events});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_LT(
        (b[i].world_from_camera.inverse() * (elsewhere * a[i].world_from_camera)).log().norm(),
        0.002);
}

TEST(IntensityTracker, AGapOfEventsIsReportedLostAndRecoveredFrom) {
  constexpr double kGap_s = 0.1, kGapEnd_s = 0.15;
  IntensityTracking tracking;
  const auto poses = tracking->track({without(kGap_s, kGapEnd_s)});
  std::size_t lost = 0;
  for (const TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    if (pose.status == TrackStatus::kLost) {
      ++lost;
      EXPECT_GE(t_s, kGap_s - 0.005);
      EXPECT_LT(t_s, 0.25);
    } else {
      EXPECT_LT(resolved_error_px(pose), 3) << "lost without knowing at " << t_s;
    }
  }
  EXPECT_GT(lost, 0U);
  const Errors errors = resolved_errors(from(0.27, poses));
  // The levels that were taken from where the edges found the pose are forgotten little by little.
  EXPECT_LT(errors.mean, 0.5);
}

TEST(IntensityTracker, StartsInTheMiddleOfARecording) {
  // By then the pixels have fired anywhere within a threshold around what the map shows.
  constexpr double kStart_s = 0.05;
  const Events events = without(0, kStart_s);
  IntensityTracking tracking;
  tracking->reset(ns_from_seconds(kStart_s), corner_motion(kStart_s));
  const Errors errors = resolved_errors(from(0.1, tracking->track({events})));
  EXPECT_LT(errors.mean, 0.12);
}

TEST(IntensityTracker, WrongLevelsAtTheStartAreForgotten) {
  // A third of the pixels is blind at first: what they miss is wrong in their levels.
  Events events;
  for (const Event& event : resolved_recording().events)
    if (event.t_ns > ns_from_seconds(0.03) || (event.x + event.y) % 3 != 0) events.push_back(event);
  IntensityTracking tracking;
  const auto poses = tracking->track({events});
  const Errors errors = resolved_errors(from(0.1, poses));
  EXPECT_LT(errors.mean, 0.12);
}

TEST(IntensityTracker, AStartBesideTheTruthIsPulledBack) {
  IntensityTracking tracking;
  const Rigid3 beside({1, 0, 0, 0}, {0.03, 0, 0});
  tracking->reset(0, corner_motion(0) * beside);
  const auto poses = tracking->track({resolved_recording().events});
  TrackedPose start;
  start.world_from_camera = corner_motion(0) * beside;
  const Errors errors = resolved_errors(from(0.15, poses));
  EXPECT_GT(resolved_error_px(start), 1.5) << "the test must start beside it";
  EXPECT_LT(errors.mean, 0.2);
}

TEST(IntensityTracker, AWrongContrastIsBornByTheCorrections) {
  IntensityTracking tracking(best(), 1.1 * kRecordedContrast);
  const Errors errors = resolved_errors(from(0, tracking->track({resolved_recording().events})));
  EXPECT_LT(errors.mean, 0.3);
}

double mean_residual(const std::vector<TrackedPose>& poses) {
  double sum = 0;
  for (const TrackedPose& pose : poses) sum += pose.residual;
  return sum / static_cast<double>(poses.size());
}

TEST(IntensityTracker, TheResidualTellsAWrongContrast) {
  const auto residual = [](double share) {
    IntensityTracking tracking(best(), share * kRecordedContrast);
    return mean_residual(tracking->track({resolved_recording().events}));
  };
  const double right = residual(1);
  EXPECT_GT(residual(0.7), 1.2 * right);
  EXPECT_GT(residual(1.3), 1.2 * right);
}

TEST(IntensityTracker, TooFewEventsGiveNoPose) {
  IntensityTracking tracking;
  EXPECT_TRUE(tracking->track({}).empty());
  // A pose takes a thousand pixels at least.
  EXPECT_TRUE(tracking->track({std::span(resolved_recording().events).first(999)}).empty());
  EXPECT_FALSE(tracking->track({std::span(resolved_recording().events).first(10000)}).empty());
}

TEST(IntensityTracker, AFewEventsAPoseFollowAsWell) {
  const auto events = std::span(resolved_recording().events).first(20000);
  for (const int count : {1, 20}) {
    TrackConfig few = best();
    few.intensity.events = count;
    IntensityTracking tracking(few);
    const auto poses = from(0, tracking->track({events}));
    EXPECT_EQ(poses.size(), events.size() / static_cast<std::size_t>(count));
    EXPECT_LT(resolved_errors(poses).mean, 0.15);
  }
}

TEST(IntensityTracker, APoseDoesNotWaitForPixelsThatSeeNothing) {
  // One pixel in four is left: a thousand of them would take far longer than what a batch may last.
  Events few;
  for (const Event& event : resolved_recording().events)
    if ((event.x + 3 * event.y) % 4 == 0) few.push_back(event);
  IntensityTracking tracking;
  const auto poses = tracking->track({few});
  ASSERT_GT(poses.size(), 15U);
  for (const TrackedPose& pose : poses)
    EXPECT_LT(seconds_from_ns(pose.last_ns - pose.first_ns), 0.05) << "a hundred pixels";
  EXPECT_LT(resolved_errors(poses).mean, 0.8) << "pixels, with a quarter of the sensor";
}

TEST(IntensityTracker, PixelsBetweenTheirEventsHoldThePose) {
  const auto error_with = [](double pixels, bool half_threshold) {
    TrackConfig config = best();
    config.intensity.no_event_ratio = pixels;
    config.intensity.half_threshold = half_threshold;
    IntensityTracking tracking(config);
    return resolved_errors(from(0, tracking->track({resolved_recording().events}))).mean;
  };
  const double events_alone = error_with(0, true);
  const double with_pixels = error_with(1, true);
  EXPECT_LT(with_pixels, 0.9 * events_alone);
  EXPECT_LT(with_pixels, error_with(1, false)) << "half a threshold nearer to the truth";
}

/// A part of the image in which something moves: it shows the events of another part.
class MovingObject {
 public:
  [[nodiscard]] static bool covers(const Event& event) {
    return event.x >= kLeft && event.x < kLeft + kSide && event.y >= kTop && event.y < kTop + kSide;
  }
  /// Its own events, and those of the rest if the camera moves, too.
  [[nodiscard]] static Events recorded(bool camera_moves) {
    Events events;
    for (Event event : resolved_recording().events) {
      if (camera_moves && !covers(event)) events.push_back(event);
      if (event.x < kShift_px) continue;
      event.x = static_cast<std::uint16_t>(event.x - kShift_px);
      if (covers(event)) events.push_back(event);
    }
    return events;
  }

 private:
  static constexpr int kLeft = 60, kTop = 40, kSide = 48, kShift_px = 50;
};

/// What pixels tell that are blind for a while after each event.
Events by_blind_pixels(const Events& events) {
  constexpr TimeNs kBlind_ns = 2'000'000;
  std::map<std::pair<int, int>, TimeNs> last_ns;
  Events seen;
  for (const Event& event : events) {
    const auto [last, is_first] = last_ns.try_emplace({event.x, event.y}, event.t_ns);
    if (!is_first && event.t_ns - last->second < kBlind_ns) continue;
    last->second = event.t_ns;
    seen.push_back(event);
  }
  return seen;
}

TEST(IntensityTracker, WhatMovesInFrontOfTheMapPullsLittle) {
  IntensityTracking tracking;
  const Errors errors =
      resolved_errors(from(0, tracking->track({by_blind_pixels(MovingObject::recorded(true))})));
  EXPECT_LT(errors.mean, 0.2) << "all parts weigh alike: 0.24";
  EXPECT_LT(errors.largest, 0.45) << "0.76";
}

TEST(IntensityTracker, TheMapAroundSomethingThatMovesHoldsThePose) {
  IntensityTracking tracking;
  const std::vector<TrackedPose> poses =
      tracking->track({by_blind_pixels(MovingObject::recorded(false))});
  ASSERT_GT(poses.size(), 5U);
  double largest = 0;
  for (const TrackedPose& pose : poses)
    largest = std::max(largest, (corner_motion(0).inverse() * pose.world_from_camera).log().norm());
  EXPECT_LT(largest, 0.017) << "all parts weigh alike: 0.021";
}

TEST(IntensityTracker, WithoutTheMapInViewItIsLost) {
  IntensityTracking tracking;
  const Rigid3 turned(so3_exp({0, std::numbers::pi, 0}), {0, 0, 0});
  tracking->reset(0, corner_motion(0) * turned);
  expect_lost_but_finite(tracking->track({std::span(resolved_recording().events).first(50000)}));
}

TEST(IntensityTracker, AMapOfNothingIsLostFromTheStart) {
  ReferenceView nothing = resolved_recording().view;
  nothing.depth.fill(0);
  IntensityTracking tracking(best(), kRecordedContrast, nothing);
  expect_lost_but_finite(tracking->track({std::span(resolved_recording().events).first(50000)}));
}

TEST(IntensityTracker, TheViewIsDrawnAnewOnlyWhereItHasMoved) {
  TrackConfig often = best();
  often.intensity.redraw_deg = 0.3;
  IntensityTracking often_drawn(often);
  IntensityTracking usual;
  const Errors finely = resolved_errors(from(0, often_drawn->track({resolved_recording().events})));
  static_cast<void>(usual->track({resolved_recording().events}));
  EXPECT_LT(usual->views_drawn(), often_drawn->views_drawn() / 2);
  EXPECT_LT(finely.mean, 0.09);
}

}  // namespace
}  // namespace saccade
