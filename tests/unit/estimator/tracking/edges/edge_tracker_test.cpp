#include "estimator/tracking/edges/edge_tracker.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/random.h"
#include "estimator/tracking/edges/edge_fallback.h"
#include "tests/unit/estimator/tracking/corner_recording.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::expect_equal;

constexpr double kEnd_s = 0.25;  ///< some 60 px of image motion

const testing::CornerRecording& recording() {
  static const testing::CornerRecording recording(testing::corner_world(160, 120), kEnd_s, 1e-3);
  return recording;
}

const MapPoints& map_points() {
  static const MapPoints map = extract_map(recording().view.log_intensity, recording().view.depth,
                                           recording().world.camera(), {});
  return map;
}

EdgeTrackerOptions accurate() { return {}; }
EdgeTrackerOptions fast() { return edge_preset(EdgeTrackerOptions::Preset::kFast); }

EdgeTracker tracker_from(const EdgeTrackerOptions& options, std::uint64_t seed = 1) {
  EdgeTracker tracker(options, recording().world.camera(), map_points(), corner_motion(0), seed);
  tracker.reset(0, corner_motion(0));
  return tracker;
}

std::vector<TrackedPose> track(const EdgeTrackerOptions& options, std::uint64_t seed = 1) {
  return tracker_from(options, seed).track({recording().events});
}

double error_px(const TrackedPose& pose) { return recording().error_px(pose); }

using Errors = testing::CornerRecording::Errors;
Errors errors_of(const std::vector<TrackedPose>& poses) { return recording().errors_of(poses); }

void expect_within(const std::vector<TrackedPose>& poses, double mean_px, double largest_px) {
  ASSERT_GT(poses.size(), 30U);
  const Errors errors = errors_of(poses);
  EXPECT_LT(errors.mean, mean_px);
  EXPECT_LT(errors.largest, largest_px);
  for (const TrackedPose& pose : poses) EXPECT_EQ(pose.status, TrackStatus::kOk);
}

/// An untracked camera would be this far off in the end.
TEST(EdgeTracker, TheTestMovesFurtherThanItsBounds) {
  TrackedPose still;
  still.t_ns = ns_from_seconds(kEnd_s);
  still.world_from_camera = corner_motion(0);
  EXPECT_GT(error_px(still), 10);
}

TEST(EdgeTracker, AccurateSettingRecoversEveryPose) { expect_within(track(accurate()), 0.6, 1.5); }

TEST(EdgeTracker, FastSettingRecoversEveryPose) { expect_within(track(fast()), 1.0, 3.0); }

TEST(EdgeTracker, ThesisSettingStaysOnTheMapWithABrightnessModel) {
  EdgeTrackerOptions options = edge_preset(EdgeTrackerOptions::Preset::kThesis);
  options.align.solve_brightness = true;
  expect_within(track(options), 1.5, 4.0);
}

TEST(EdgeTracker, EverySelectionOfPointsRecoversEveryPose) {
  for (const auto kind : {SelectionOptions::Kind::kDense, SelectionOptions::Kind::kSemiDense,
                          SelectionOptions::Kind::kSparsePatches}) {
    EdgeTrackerOptions options = accurate();
    options.align.selection.kind = kind;
    expect_within(track(options), 0.6, 1.5);
  }
}

TEST(EdgeTracker, SlidingFramesGiveMorePosesOfTheSameQuality) {
  for (const EdgeTrackerOptions& options : {accurate(), fast()}) {
    EdgeTrackerOptions sliding = options;
    sliding.event_frame.window = EventFrameOptions::Window::kSliding;
    sliding.event_frame.new_fraction = 0.25;
    const auto poses = track(sliding);
    EXPECT_NEAR(static_cast<double>(poses.size()) / static_cast<double>(track(options).size()), 4,
                0.4);
    expect_within(poses, 1.0, 3.0);
    for (std::size_t i = 1; i < poses.size(); ++i) EXPECT_GE(poses[i].t_ns, poses[i - 1].t_ns);
  }
}

TEST(EdgeTracker, TimeSurfacesRecoverEveryPose) {
  for (const auto window :
       {EventFrameOptions::Window::kDisjoint, EventFrameOptions::Window::kSliding}) {
    EdgeTrackerOptions options = accurate();
    options.event_frame.kind = EventFrameOptions::Kind::kTimeSurface;
    options.event_frame.window = window;
    const auto poses = track(options);
    expect_within(poses, 0.6, 1.5);
    for (const TrackedPose& pose : poses) {
      EXPECT_GT(pose.t_ns, pose.first_ns / 2 + pose.last_ns / 2) << "recent events count more";
      EXPECT_LE(pose.t_ns, pose.last_ns);
    }
  }
}

TEST(EdgeTracker, CoarseToFineRecoversEveryPoseAndAnOffsetStart) {
  EdgeTrackerOptions options = accurate();
  options.align.pyramid_levels = 3;
  expect_within(track(options), 0.6, 1.5);
  // Some 6 px beside the truth, further than an edge is wide.
  EdgeTracker tracker = tracker_from(options);
  tracker.reset(0, corner_motion(0) * Rigid3({1, 0, 0, 0}, {0.09, 0.02, 0}));
  const auto poses = tracker.track({recording().events});
  TrackedPose start = poses.front();
  start.world_from_camera = start.world_from_camera * Rigid3({1, 0, 0, 0}, {0.09, 0.02, 0});
  EXPECT_GT(error_px(start), 4) << "the test must start far away";
  EXPECT_LT(error_px(poses.back()), 1.5);
}

/// What a gyroscope in the camera's frame reads at 1 kHz.
Gyroscope gyroscope_of_the_motion() {
  constexpr double kHalf_s = 1e-5;
  std::vector<ImuSample> samples;
  for (double t_s = 0; t_s <= kEnd_s; t_s += 1e-3) {
    const Rigid3 turn = corner_motion(t_s - kHalf_s).inverse() * corner_motion(t_s + kHalf_s);
    ImuSample sample;
    sample.t_ns = ns_from_seconds(t_s);
    sample.angular_velocity = so3_log(turn.rotation()) / (2 * kHalf_s);
    samples.push_back(sample);
  }
  return {samples, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
}

TEST(EdgeTracker, AGyroscopeHelpsTheFastSetting) {
  EdgeTrackerOptions options = fast();
  options.motion.prediction = MotionModelOptions::Prediction::kImu;
  EdgeTracker tracker = tracker_from(options);
  tracker.set_gyroscope(gyroscope_of_the_motion());
  const auto poses = tracker.track({recording().events});
  expect_within(poses, 1.0, 3.0);
  EXPECT_LT(errors_of(poses).mean, errors_of(track(fast())).mean);
}

TEST(EdgeTracker, PosesFollowOneAnotherInTime) {
  TimeNs last = -1;
  for (const TrackedPose& pose : track(accurate())) {
    EXPECT_GE(pose.first_ns, last);
    EXPECT_LE(pose.first_ns, pose.t_ns);
    EXPECT_LE(pose.t_ns, pose.last_ns);
    last = pose.last_ns;
    EXPECT_EQ(pose.iterations, accurate().align.iterations);
    EXPECT_GT(pose.residual, 0);
    EXPECT_LT(pose.residual, 1);
  }
}

TEST(EdgeTracker, EventsPerFrameFollowTheRatio) {
  EdgeTrackerOptions half = accurate();
  half.event_frame.event_map_ratio = accurate().event_frame.event_map_ratio / 2;
  const double ratio =
      static_cast<double>(track(half).size()) / static_cast<double>(track(accurate()).size());
  EXPECT_NEAR(ratio, 2, 0.2);
}

TEST(EdgeTracker, TooFewEventsGiveNoPose) {
  const Events& events = recording().events;
  EdgeTracker tracker = tracker_from(accurate());
  EXPECT_TRUE(tracker.track({}).empty());
  const auto needed = static_cast<std::size_t>(accurate().event_frame.min_events);
  EXPECT_TRUE(tracker.track({std::span(events).first(needed - 1)}).empty());
}

TEST(EdgeTracker, MinEventsHoldWhereNoMapIsInView) {
  EdgeTrackerOptions options = accurate();
  options.event_frame.min_events = 150;
  const MapPoints nothing;
  EdgeTracker tracker(options, recording().world.camera(), nothing, {}, 1);
  tracker.reset(0, {});
  const auto poses = tracker.track({std::span(recording().events).first(1000)});
  ASSERT_EQ(poses.size(), 1000U / 150);
  for (const TrackedPose& pose : poses) {
    EXPECT_EQ(pose.status, TrackStatus::kLost);
    EXPECT_EQ(pose.world_from_camera.translation(), Eigen::Vector3d::Zero());
  }
}

TEST(EdgeTracker, ProgressCountsTheEventsOfWholeFrames) {
  EdgeTracker tracker = tracker_from(accurate());
  std::size_t done = 0;
  const auto poses = tracker.track({recording().events}, [&](std::size_t n) { done += n; });
  EXPECT_LE(done, recording().events.size());
  EXPECT_GT(done, recording().events.size() * 9 / 10);
}

/// Events at random pixels, as many per second as in the recording, after it.
Events uniform_noise(TimeNs start_ns, std::size_t count) {
  const Random random(23);
  const PinholeCamera& camera = recording().world.camera();
  const auto step =
      static_cast<TimeNs>(kEnd_s * 1e9) / static_cast<TimeNs>(recording().events.size());
  Events events;
  for (std::size_t i = 0; i < count; ++i)
    events.push_back(
        {start_ns + step * static_cast<TimeNs>(i),
         static_cast<std::uint16_t>(random.below(static_cast<std::uint64_t>(camera.width), 0, i)),
         static_cast<std::uint16_t>(random.below(static_cast<std::uint64_t>(camera.height), 1, i)),
         static_cast<std::int8_t>(i % 2 == 0 ? 1 : -1)});
  return events;
}

/// Share of lost poses after the events have turned into noise.
double lost_in_noise(const EdgeTrackerOptions& options) {
  EdgeTracker tracker = tracker_from(options);
  const Events& events = recording().events;
  static_cast<void>(tracker.track({std::span(events).first(events.size() / 2)}));
  const auto poses =
      tracker.track({uniform_noise(events[events.size() / 2].t_ns, events.size() / 2)});
  EXPECT_GT(poses.size(), 20U);
  double lost = 0;
  for (const TrackedPose& pose : poses) {
    lost += pose.status == TrackStatus::kLost ? 1 : 0;
    EXPECT_TRUE(pose.world_from_camera.translation().allFinite());
  }
  return lost / static_cast<double>(poses.size());
}

TEST(EdgeTracker, UniformNoiseIsReportedAsLost) { EXPECT_GT(lost_in_noise(accurate()), 0.5); }

// So few samples follow single events of the noise: the ratio of inliers is only now and then as
// low as chance.
TEST(EdgeTracker, FastSettingReportsUniformNoiseNowAndThen) { EXPECT_GT(lost_in_noise(fast()), 0); }

TEST(EdgeTracker, OneBadFrameIsNotALoss) {
  constexpr int kLostFrames = 3;
  EdgeTrackerOptions options = accurate();
  options.min_inlier_ratio = 1;  // every frame is suspicious
  const auto poses = track(options);
  ASSERT_GT(poses.size(), 5U);
  for (int i = 0; i < kLostFrames - 1; ++i)
    EXPECT_EQ(poses[static_cast<std::size_t>(i)].status, TrackStatus::kOk);
  for (std::size_t i = static_cast<std::size_t>(kLostFrames) - 1; i < poses.size(); ++i)
    EXPECT_EQ(poses[i].status, TrackStatus::kLost);
}

TEST(EdgeTracker, FramesThatDoNotFitAreLostAndThreeOfThemTheCamera) {
  EdgeTracker tracker = tracker_from(accurate());
  tracker.start(recording().events);
  ASSERT_EQ(tracker.next().value().status, TrackStatus::kOk);
  MapPoints behind;
  behind.x = behind.y = {0};
  behind.z = {-1};
  tracker.set_map(behind);
  for (const bool is_lost : {false, false, true, true}) {
    EXPECT_EQ(tracker.next().value().status, TrackStatus::kLost);
    EXPECT_EQ(tracker.is_lost(), is_lost);
  }
}

TEST(EdgeTracker, TheSeedRepeatsTheRun) {
  for (const EdgeTrackerOptions& options : {accurate(), fast()}) {
    const auto first = track(options, 5);
    expect_equal(first, track(options, 5));
    const auto other = track(options, 6);
    EXPECT_NE(first.back().world_from_camera.translation(),
              other.back().world_from_camera.translation());
    EXPECT_LT(errors_of(other).largest, 3);
  }
}

TEST(EdgeTracker, ResetStartsAnew) {
  for (const EdgeTrackerOptions& options : {accurate(), fast()}) {
    EdgeTracker tracker = tracker_from(options);
    const auto first = tracker.track({recording().events});
    tracker.reset(0, corner_motion(0));
    expect_equal(first, tracker.track({recording().events}));
  }
}

TEST(EdgeTracker, DoesNotDependOnWhereTheWorldBegins) {
  const Rigid3 elsewhere(so3_exp({0.5, -1, 2}), {100, -20, 3});
  EdgeTracker tracker(accurate(), recording().world.camera(), map_points(),
                      elsewhere * corner_motion(0), 1);
  tracker.reset(0, elsewhere * corner_motion(0));
  const auto moved = tracker.track({recording().events});
  const auto poses = track(accurate());
  ASSERT_EQ(moved.size(), poses.size());
  // Rounding of a position of 100 m may tip single samples over pixel borders.
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT((moved[i].world_from_camera.inverse() * (elsewhere * poses[i].world_from_camera))
                  .translation()
                  .norm(),
              0.02);
}

TEST(EdgeTracker, TellsHowManyEventsTheNextFrameTakes) {
  EdgeTracker tracker = tracker_from(accurate());
  const std::size_t needed = tracker.next_frame_events();
  EXPECT_GT(needed, static_cast<std::size_t>(accurate().event_frame.min_events));
  EXPECT_TRUE(tracker.track({std::span(recording().events).first(needed - 1)}).empty());
  tracker.reset(0, corner_motion(0));
  EXPECT_EQ(tracker.track({std::span(recording().events).first(needed)}).size(), 1U);
}

TEST(EdgeTracker, AnUncertainStartIsLeftFasterThanASureOne) {
  const Rigid3 beside({1, 0, 0, 0}, {0.03, 0.01, 0});
  EdgeTrackerOptions options = accurate();
  options.motion.prediction = MotionModelOptions::Prediction::kConstantVelocity;
  const auto error_of_the_first = [&](double sigma_px) {
    EdgeTracker tracker = tracker_from(options);
    tracker.reset(0, corner_motion(0) * beside, sigma_px);
    return error_px(tracker.track({std::span(recording().events).first(20000)}).front());
  };
  EXPECT_LT(error_of_the_first(4), error_of_the_first(0.02));
}

TEST(EdgeTracker, KeptTemplatesAreDrawnLessOften) {
  EdgeTrackerOptions always = accurate();
  always.templates.redraw_px = 0;
  EdgeTrackerOptions kept = accurate();
  kept.templates.redraw_px = 4;
  EdgeTracker often = tracker_from(always);
  EdgeTracker seldom = tracker_from(kept);
  const auto poses = often.track({recording().events});
  EXPECT_EQ(often.templates_drawn(), poses.size() + 1) << "one more to know when a frame is full";
  expect_within(seldom.track({recording().events}), 1.0, 2.0);
  EXPECT_LT(seldom.templates_drawn(), often.templates_drawn());
}

/// Follows the camera until it jumps out of sight: a turn of 0.5 rad that no event tells of.
TEST(EdgeTracker, FindsTheCameraAgainWhereItMayBe) {
  EdgeTracker tracker = tracker_from(accurate());
  tracker.start(recording().events);
  std::optional<TrackedPose> last;
  for (int i = 0; i < 40; ++i) last = tracker.next();
  ASSERT_TRUE(last);
  ASSERT_LT(error_px(*last), 1.5);
  tracker.correct(Rigid3(so3_exp({0.3, 0.4, 0.2}), Eigen::Vector3d::Zero()));
  for (int i = 0; i < 3; ++i) last = tracker.next();
  ASSERT_GT(error_px(*last), 20);
  const Rigid3 near = corner_motion(seconds_from_ns(last->t_ns)) *
                      Rigid3(so3_exp({0.01, -0.01, 0.02}), Eigen::Vector3d::Zero());
  const std::vector<Rigid3> places = {last->world_from_camera, near};
  const std::optional<TrackedPose> found = tracker.relocate(places);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->status, TrackStatus::kRelocalised);
  EXPECT_EQ(found->last_ns, last->last_ns);
  EXPECT_LT(error_px(*found), 2);
  const std::optional<TrackedPose> next = tracker.next();
  ASSERT_TRUE(next);
  EXPECT_LT(error_px(*next), 2);
}

TEST(EdgeTracker, ACameraThatIsTwoPixelsOffIsNotElsewhere) {
  // It agrees better two pixels beside where it was put, but goes on from there by itself.
  EdgeTracker tracker = tracker_from(accurate());
  tracker.start(recording().events);
  std::optional<TrackedPose> last;
  for (int i = 0; i < 20; ++i) last = tracker.next();
  const auto aside = [&](double turn_rad) {
    tracker.correct(Rigid3(so3_exp({turn_rad, 0, 0}), Eigen::Vector3d::Zero()));
  };
  const Rigid3 here = last->world_from_camera;
  const double px = recording().world.camera().fx;
  // The last frame, aligned so far away, agreed with nothing.
  aside(30 / px);
  for (int i = 0; i < 3; ++i) (void)tracker.next();
  aside(-28 / px);
  EXPECT_FALSE(tracker.relocate({&here, 1}));
  aside(-20 / px);
  EXPECT_TRUE(tracker.relocate({&here, 1}));
}

TEST(EdgeTracker, FindsNothingWhereTheCameraIsNot) {
  EdgeTracker tracker = tracker_from(accurate());
  tracker.start(recording().events);
  std::optional<TrackedPose> last;
  for (int i = 0; i < 20; ++i) last = tracker.next();
  ASSERT_TRUE(last);
  const std::vector<Rigid3> places = {last->world_from_camera *
                                      Rigid3(so3_exp({0.3, 0.4, 0.2}), {0.3, 0.1, 0})};
  EXPECT_FALSE(tracker.relocate(places));
  EXPECT_FALSE(tracker.relocate({}));
  // Tracking goes on as if nothing had been looked for.
  const std::optional<TrackedPose> next = tracker.next();
  ASSERT_TRUE(next);
  EXPECT_LT(error_px(*next), 1.5);
}

TEST(EdgeFallback, HandsOverThePoseOfItsLastFrame) {
  EdgeFallback fallback(tracker_from(accurate()));
  std::vector<TrackedPose> poses(1);  // of before
  TrackTiming timing;
  const std::size_t done = fallback.follow({recording().events}, poses, timing);
  EXPECT_GT(done, 0U);
  EXPECT_EQ(poses.size(), 7U);
  EXPECT_TRUE(fallback.fits());
  EXPECT_EQ(poses.back().status, TrackStatus::kOk);
  EXPECT_LT(error_px(poses.back()), 1.5);
  EXPECT_GT(timing.align_s, 0);
  EXPECT_EQ(fallback.follow({std::span(recording().events).first(10)}, poses, timing), 0U);
  EXPECT_EQ(poses.size(), 7U) << "too few events give no pose";
}

TEST(EdgeFallback, TakesFewerFramesAtTheEndAlone) {
  EdgeFallback fallback(tracker_from(accurate()));
  std::vector<TrackedPose> poses;
  TrackTiming timing;
  Recording part{recording().events};
  const std::size_t all = fallback.follow(part, poses, timing);
  fallback.reset(0, corner_motion(0));
  poses.clear();
  part.events = part.events.first(all / 2);
  part.is_complete = false;
  EXPECT_EQ(fallback.follow(part, poses, timing), 0U);
  EXPECT_TRUE(poses.empty());
  part.is_complete = true;
  EXPECT_EQ(fallback.follow(part, poses, timing), all / 2);
  EXPECT_EQ(poses.size(), 3U);
}

TEST(EdgeFallback, PosesThatDoNotFitAreLost) {
  EdgeFallback fallback(tracker_from(accurate()));
  fallback.reset_near(0, corner_motion(0) * Rigid3(so3_exp({0, 3, 0}), Eigen::Vector3d::Zero()));
  std::vector<TrackedPose> poses;
  TrackTiming timing;
  EXPECT_GT(fallback.follow({recording().events}, poses, timing), 0U);
  EXPECT_FALSE(fallback.fits());
  testing::expect_lost_but_finite(poses);
}

}  // namespace
}  // namespace saccade
