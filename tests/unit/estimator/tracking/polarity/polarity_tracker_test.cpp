#include "estimator/tracking/polarity/polarity_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::expect_equal;
using testing::expect_lost_but_finite;
using testing::resolved_errors;
using testing::resolved_recording;
using testing::tracking_config;
using Errors = testing::CornerRecording::Errors;

TrackConfig polarity() { return tracking_config("polarity"); }

/// The tracker with all that has to outlive it.
class PolarityTracking {
 public:
  explicit PolarityTracking(const TrackConfig& config = polarity(),
                            const ReferenceView& view = resolved_recording().view)
      : map_(resolved_recording().world.camera(), std::span(&view, 1), 0),
        points_(extract_map(view.log_intensity, view.depth, map_.camera(), config.map)),
        edges_(testing::fallback_options(config), map_.camera(), points_, map_.world_from_map(),
               config.seed),
        tracker_(config.polarity, config.motion, map_.camera(), map_, edges_) {
    tracker_.reset(0, view.world_from_reference);
  }

  PolarityTracker* operator->() { return &tracker_; }

 private:
  IntensityMap map_;
  MapPoints points_;
  EdgeTracker edges_;
  PolarityTracker tracker_;
};

/// At about 0.22 s the camera turns back: increments of both signs are in one frame.
constexpr double kBeforeTheTurn_s = 0.2;

/// The poses after the velocity has been found and before the camera turns back.
std::vector<TrackedPose> steady(const std::vector<TrackedPose>& poses) {
  std::vector<TrackedPose> between;
  for (const TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    if (t_s >= 0.05 && t_s < kBeforeTheTurn_s) between.push_back(pose);
  }
  EXPECT_GT(between.size(), 10U);
  return between;
}

void expect_tracked(const std::vector<TrackedPose>& poses) {
  for (const TrackedPose& pose : poses)
    EXPECT_EQ(pose.status, TrackStatus::kOk) << seconds_from_ns(pose.t_ns);
}

TEST(PolarityTracker, RecoversEveryPoseAndBeatsTheEdges) {
  PolarityTracking tracking;
  const auto poses = tracking->track({resolved_recording().events});
  expect_tracked(poses);
  const Errors errors = resolved_errors(steady(poses));
  EXPECT_LT(errors.mean, 0.2);
  EXPECT_LT(errors.largest, 0.6);

  const TrackConfig edges = tracking_config("accurate");
  const ReferenceView& view = resolved_recording().view;
  const PinholeCamera& camera = resolved_recording().world.camera();
  const MapPoints points = extract_map(view.log_intensity, view.depth, camera, edges.map);
  EdgeTracker tracker(edges.edges, camera, points, view.world_from_reference, 1);
  tracker.reset(0, view.world_from_reference);
  EXPECT_LT(1.3 * errors.mean,
            resolved_errors(steady(tracker.track({resolved_recording().events}))).mean);
}

TEST(PolarityTracker, ARecordingOfAFewFramesHasPoses) {
  PolarityTracking tracking;
  const auto all = tracking->track({resolved_recording().events});
  ASSERT_GT(all.size(), 6U);
  // The first pose is that of the edges' first frame, of which the fallback follows six at once.
  const auto frame = static_cast<std::size_t>(
      std::count_if(resolved_recording().events.begin(), resolved_recording().events.end(),
                    [&](const Event& e) { return e.t_ns <= all.front().last_ns; }));
  PolarityTracking again;
  const auto few = again->track({std::span(resolved_recording().events).first(3 * frame + 1)});
  EXPECT_GE(few.size(), 1U);
  EXPECT_LT(few.size(), 6U);
  PolarityTracking none;
  EXPECT_TRUE(none->track({std::span(resolved_recording().events).first(frame / 2)}).empty());
}

TEST(PolarityTracker, DoesNotKnowTheContrast) {
  const testing::CornerRecording coarse(testing::resolved_world(), 0.15, 2e-4, 0.3);
  PolarityTracking tracking;
  const auto poses = tracking->track({coarse.events});
  expect_tracked(poses);
  EXPECT_LT(resolved_errors(steady(poses)).mean, 0.4);
}

TEST(PolarityTracker, ReversalsTakeTheLagAway) {
  TrackConfig plain = polarity();
  plain.polarity.reversals = false;
  PolarityTracking without(plain);
  PolarityTracking with;
  EXPECT_LT(1.2 * resolved_errors(steady(with->track({resolved_recording().events}))).mean,
            resolved_errors(steady(without->track({resolved_recording().events}))).mean);
}

TEST(PolarityTracker, PosesFollowOneAnotherInTime) {
  PolarityTracking tracking;
  std::size_t done = 0;
  const auto poses =
      tracking->track({resolved_recording().events}, [&](std::size_t n) { done += n; });
  EXPECT_LE(done, resolved_recording().events.size());
  EXPECT_GT(done + 20000, resolved_recording().events.size());
  TimeNs last = -1;
  for (const TrackedPose& pose : poses) {
    EXPECT_GE(pose.first_ns, last);
    EXPECT_LE(pose.first_ns, pose.t_ns);
    EXPECT_LE(pose.t_ns, pose.last_ns);
    EXPECT_GT(pose.inlier_ratio, 0.55);
    EXPECT_LE(pose.inlier_ratio, 1);
    EXPECT_GT(pose.position_sigma_m, 0);
    EXPECT_LT(pose.rotation_sigma_rad, 0.1);
    last = pose.last_ns;
  }
}

TEST(PolarityTracker, RepeatsItsBits) {
  PolarityTracking tracking;
  const auto first = tracking->track({resolved_recording().events});
  PolarityTracking other;
  expect_equal(first, other->track({resolved_recording().events}));
  tracking->reset(0, corner_motion(0));
  expect_equal(first, tracking->track({resolved_recording().events}));
}

TEST(PolarityTracker, DoesNotDependOnWhereTheWorldBegins) {
  const Rigid3 elsewhere(so3_exp({0.5, -1, 2}), {100, -20, 3});
  ReferenceView moved = resolved_recording().view;
  moved.world_from_reference = elsewhere * corner_motion(0);
  PolarityTracking here;
  PolarityTracking there(polarity(), moved);
  const auto a = here->track({resolved_recording().events});
  const auto b = there->track({resolved_recording().events});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_LT(
        (b[i].world_from_camera.inverse() * (elsewhere * a[i].world_from_camera)).log().norm(),
        0.02);
}

TEST(PolarityTracker, TooFewEventsGiveNoPose) {
  PolarityTracking tracking;
  EXPECT_TRUE(tracking->track({}).empty());
  EXPECT_TRUE(tracking->track({std::span(resolved_recording().events).first(2999)}).empty());
}

/// Events at random pixels, as dense as those of the recording, after it.
Events noise_after(std::span<const Event> events) {
  const Random random(23);
  Events noise;
  for (std::uint64_t i = 0; i < events.size(); ++i)
    noise.push_back({events.back().t_ns + events[i].t_ns,
                     static_cast<std::uint16_t>(random.below(160, 0, i)),
                     static_cast<std::uint16_t>(random.below(120, 1, i)),
                     static_cast<std::int8_t>(random.uniform(2, i) < 0.5 ? 1 : -1)});
  return noise;
}

TEST(PolarityTracker, NoiseIsReportedLost) {
  PolarityTracking tracking;
  const auto events = std::span(resolved_recording().events).first(60000);
  expect_tracked(tracking->track({events}));
  const auto poses = tracking->track({noise_after(events)});
  double lost = 0;
  for (const TrackedPose& pose : poses) {
    lost += pose.status == TrackStatus::kLost ? 1 : 0;
    EXPECT_TRUE(pose.world_from_camera.translation().allFinite());
  }
  EXPECT_GT(lost, 0.5 * static_cast<double>(poses.size()));
}

TEST(PolarityTracker, AShortDisturbanceIsOvercome) {
  PolarityTracking tracking;
  const auto events = std::span(resolved_recording().events);
  const auto before = events.first(events.size() / 2);
  expect_tracked(tracking->track({before}));
  // For a moment nothing that is seen means anything.
  Events wrong = noise_after(before.first(3000));
  for (Event& event : wrong) event.t_ns = before.back().t_ns;
  static_cast<void>(tracking->track({wrong}));
  const auto poses = tracking->track({events.subspan(events.size() / 2)});
  ASSERT_FALSE(poses.empty());
  EXPECT_EQ(poses.back().status, TrackStatus::kOk);
  EXPECT_LT(resolved_recording().error_px(poses.back()), 0.6);
}

TEST(PolarityTracker, EdgesGoOnWhereTheCameraTurnsBack) {
  PolarityTracking tracking;
  const auto poses = tracking->track({resolved_recording().events});
  expect_tracked(poses);
  int by_edges = 0;
  for (const TrackedPose& pose : poses)
    if (seconds_from_ns(pose.t_ns) > kBeforeTheTurn_s)
      by_edges += pose.iterations == EdgeTrackerOptions{}.align.iterations ? 1 : 0;
  EXPECT_GT(by_edges, 0);
  EXPECT_LT(by_edges, 20);
  EXPECT_LT(resolved_recording().error_px(poses.back()), 1);
}

TEST(PolarityTracker, WithoutTheMapInViewItIsLost) {
  PolarityTracking tracking;
  const Rigid3 turned(so3_exp({0, std::numbers::pi, 0}), {0, 0, 0});
  tracking->reset(0, corner_motion(0) * turned);
  expect_lost_but_finite(tracking->track({std::span(resolved_recording().events).first(50000)}));
}

TEST(PolarityTracker, AMapOfNothingIsLostFromTheStart) {
  ReferenceView nothing = resolved_recording().view;
  nothing.depth.fill(0);
  PolarityTracking tracking(polarity(), nothing);
  expect_lost_but_finite(tracking->track({std::span(resolved_recording().events).first(50000)}));
}

}  // namespace
}  // namespace saccade
