#include "estimator/odometry/odometry_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/config/config.h"
#include "core/io/covariance_file.h"
#include "core/io/run/keyframe_list.h"
#include "core/io/run/view_list.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "core/random.h"
#include "estimator/odometry/odometry_config.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/support/recording.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;
using testing::TemporaryFolder;

constexpr double kEnd_s = 0.5;
constexpr double kDepth_m = 2.2;

/// Sideways with a turn, seen by a small camera in front of a corner.
Rigid3 glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.25 * t_s, 0.3 * t_s}),
          {0.8 * t_s, 0.1 * std::sin(6 * t_s), 0.1 * t_s}};
}

/// The same at constant velocity: without given poses the events of a small camera do not tell a
/// velocity that changes from a rotation.
Rigid3 steady_glide(double t_s) {
  return {so3_exp({0.1 * t_s, -0.25 * t_s, 0.3 * t_s}), {1.2 * t_s, 0.3 * t_s, 0.1 * t_s}};
}

std::vector<StampedPose> poses_until(double end_s, const testing::Motion& motion = glide) {
  std::vector<StampedPose> poses;
  for (int i = 0; i * 1e-3 <= end_s + 1e-9; ++i) poses.push_back({i * 1e-3, motion(i * 1e-3)});
  return poses;
}

void write_poses_until(const fs::path& folder, double end_s) {
  write_tum_trajectory(folder / "groundtruth.txt", poses_until(end_s));
}

/// That a run's poses are true to 1.5 % of the depth, of 0.35 m and 0.16 rad that the camera moved.
void expect_glide(const fs::path& run) {
  double most_m = 0, most_rad = 0;
  const Trajectory found = read_trajectory(run / "trajectory.txt");
  for (const StampedPose& pose : found.poses()) {
    const Rigid3 error = glide(pose.t_s).inverse() * pose.world_from_camera;
    most_m = std::max(most_m, error.translation().norm());
    most_rad = std::max(most_rad, so3_log(error.rotation()).norm());
  }
  EXPECT_LT(most_m, 0.015 * kDepth_m);
  EXPECT_LT(most_rad, 0.015);
}

constexpr const char* kQuick = R"(
start: {truth_s: 0.2, truth_fraction: 0.4}
keyframe: {distance: 0.05, active: 3}
mapping: {duration_s: 0.3, min_edges: 0, image: false}
adjustment: {rounds: 0, edges: 500}
tracking: {event_map_ratio: 0.2}
)";

OdometryConfig quick() {
  return config::read<OdometryConfig>(config::parse(kQuick, "configuration"));
}

/// With the adjustment of every keyframe.
std::string adjusted() {
  std::string yaml = kQuick;
  yaml.replace(yaml.find("rounds: 0"), 9, "rounds: 1");
  return yaml;
}

/// A tenth of a second of given poses shows too few edges.
std::string with_short_start() {
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2"), 12, "truth_s: 0.1");
  yaml.replace(yaml.find("min_edges: 0"), 12, "min_edges: 900");
  return yaml;
}

class OdometryModule : public testing::SharedFolder<OdometryModule> {
 public:
  static void fill() {
    const testing::PlanarWorld world = testing::corner_world(160, 120);
    const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
    testing::write_recording(dataset(), world.camera(),
                             world.simulate(glide, 0, kEnd_s, 1e-3, 0.12), std::span(&blank, 1),
                             poses_until(kEnd_s));
  }

 protected:
  [[nodiscard]] static fs::path dataset() { return path("corner"); }

  [[nodiscard]] RunRequest request(const std::string& name, const std::string& yaml = kQuick) {
    return testing::run_request(dataset(), folder_.path() / name, yaml);
  }

  TemporaryFolder folder_;
};

TEST_F(OdometryModule, FollowsTheTrueMotionByItsOwnMap) {
  const RunSummary summary = run_odometry(request("run", adjusted()));
  EXPECT_GT(summary.poses, 20U);
  EXPECT_EQ(summary.lost_poses, 0U);
  const fs::path run = folder_.path() / "run";
  EXPECT_GE(read_trajectory(run / "trajectory.txt").start_s(), 0.2) << "given poses are no output";
  expect_glide(run);
}

TEST_F(OdometryModule, TheEventsOfSomeOfThePixelsWillDo) {
  std::string yaml = adjusted();
  (void)run_odometry(request("all", yaml));
  yaml.replace(yaml.find("duration_s: 0.3"), 15, "duration_s: 0.3, depth_events: 120000");
  (void)run_odometry(request("some", yaml));
  expect_glide(folder_.path() / "some");
  const auto all = read_keyframe_list(folder_.path() / "all" / "keyframes.yaml");
  const auto some = read_keyframe_list(folder_.path() / "some" / "keyframes.yaml");
  ASSERT_GT(all.front().events, 120000) << "there are events to leave out";
  EXPECT_EQ(some.front().events, all.front().events) << "the window is as long";
  EXPECT_LT(some.front().edges, all.front().edges);
  yaml.replace(yaml.find("depth_events: 120000"), 18, "depth_events: 100");
  EXPECT_THAT(error_of([&] { return run_odometry(request("hardly any", yaml)); }),
              HasSubstr("show no edges in depth"));
}

TEST_F(OdometryModule, AStartOfAFewPixelsIsMappedAtTheDepthThatEdgesHaveInCommon) {
  const RunSummary summary = run_odometry(request("run", with_short_start()));
  EXPECT_THAT(summary.found, Not(HasSubstr("extrapolated")));
  const fs::path run = folder_.path() / "run";
  expect_glide(run);
  const auto keyframes = read_keyframe_list(run / "keyframes.yaml");
  EXPECT_LE(keyframes.front().made_s, 0.1);
  EXPECT_GE(keyframes.front().edges, 900);
  EXPECT_LT(keyframes.front().points, keyframes.front().edges) << "an assumed depth is not found";
}

TEST_F(OdometryModule, AStartOfTooFewEdgesIsExtrapolated) {
  std::string yaml = with_short_start();
  yaml.replace(yaml.find("min_edges: 900"), 14, "min_edges: 2500");
  const RunSummary summary = run_odometry(request("run", yaml));
  EXPECT_THAT(summary.found, HasSubstr(", the start extrapolated for 0."));
  const fs::path run = folder_.path() / "run";
  expect_glide(run);
  const Trajectory found = read_trajectory(run / "trajectory.txt");
  EXPECT_GT(found.start_s(), 0.1) << "given poses are no output";
  EXPECT_LT(found.start_s(), 0.102) << "those of the extrapolation are";
  EXPECT_GT(read_keyframe_list(run / "keyframes.yaml").front().made_s, 0.11);
}

TEST_F(OdometryModule, AShortBaselineIsDoubled) {
  std::string yaml = with_short_start();
  yaml.replace(yaml.find("distance: 0.05"), 14, "distance: 0.4, interval_s: 1");
  yaml += "smoothing_s: 0\n";  // with it a quarter of the baseline will do
  (void)run_odometry(request("run", yaml));
  const auto keyframes = read_keyframe_list(folder_.path() / "run" / "keyframes.yaml");
  // 0.4 of the depth, and a second, are beyond the path's end; twice the first 0.1 m are not.
  ASSERT_GE(keyframes.size(), 2U);
  EXPECT_LE(keyframes.size(), 3U) << "as often as a baseline can be doubled";
  const auto gone_m = [&](std::size_t i) {
    return glide(keyframes[i].made_s).translation().norm();
  };
  EXPECT_GT(gone_m(1), 1.7 * gone_m(0));
}

TEST_F(OdometryModule, BeyondARotationTheScaleIsAGuess) {
  const testing::Motion motion = [](double t_s) {
    const double slid_m = t_s < 0.15 ? 0 : 0.8 * (t_s - 0.15);
    return Rigid3(so3_exp({0.2 * t_s, -0.6 * t_s, 0.3 * t_s}), {slid_m, 0, 0});
  };
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
  const fs::path data = folder_.path() / "turn";
  testing::write_recording(data, world.camera(), world.simulate(motion, 0, kEnd_s, 1e-3, 0.12),
                           std::span(&blank, 1), poses_until(kEnd_s, motion));
  std::string yaml = with_short_start();
  const RunSummary summary = run_odometry(testing::run_request(data, folder_.path() / "run", yaml));
  EXPECT_THAT(summary.found, HasSubstr("the scale a guess"));
  const CsvColumns poses(folder_.path() / "run" / "poses.csv");
  const Trajectory path = read_trajectory(folder_.path() / "run" / "trajectory.txt");
  ASSERT_EQ(poses.rows(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const StampedPose& pose = path.poses()[i];
    const bool is_lost = poses.text(i, poses.require("status")) == "lost";
    if (pose.t_s < 0.14) {
      EXPECT_LT(angle_between(pose.world_from_camera.rotation(), motion(pose.t_s).rotation()),
                0.02);
      EXPECT_FALSE(is_lost) << pose.t_s;
    }
    if (pose.world_from_camera.translation().norm() > 0.08 * kDepth_m) {
      EXPECT_TRUE(is_lost) << pose.t_s;
    }
  }
  EXPECT_GT(summary.lost_poses, 0U);
}

TEST_F(OdometryModule, AFastTurnIsFollowed) {
  // To one side by 29 degrees and as far to the other, at up to 4.7 rad/s, while the camera moves by
  // 5 mm.
  const testing::Motion motion = [](double t_s) {
    return Rigid3(so3_exp({0, 0.5 * std::sin(3 * std::numbers::pi * t_s), 0}), {0.01 * t_s, 0, 0});
  };
  const testing::PlanarWorld world = testing::wall_world(120, 90, 100, kDepth_m, 240, 180);
  const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
  const fs::path data = folder_.path() / "fast turn";
  testing::write_recording(data, world.camera(), world.simulate(motion, 0, kEnd_s, 1e-3, 0.3),
                           std::span(&blank, 1), poses_until(kEnd_s, motion));
  const fs::path run = folder_.path() / "run";
  const RunSummary summary = run_odometry(testing::run_request(data, run, with_short_start()));
  EXPECT_THAT(summary.found, HasSubstr("the scale a guess"));
  const CsvColumns poses(run / "poses.csv");
  for (std::size_t i = 0; i < poses.rows(); ++i)
    ASSERT_EQ(poses.text(i, poses.require("tracker_lost")), "0");
  EXPECT_GE(read_keyframe_list(run / "keyframes.yaml").size(), 4U);
  const Trajectory found = read_trajectory(run / "trajectory.txt");
  EXPECT_GT(found.end_s(), kEnd_s - 0.03);
  for (const StampedPose& pose : found.poses())
    ASSERT_LT(angle_between(pose.world_from_camera.rotation(), motion(pose.t_s).rotation()), 0.05)
        << pose.t_s;
  const std::vector<RunView> views = read_view_list(run / "views.yaml");
  for (std::size_t i = 1; i < views.size(); ++i) EXPECT_GT(views[i].t_s, views[i - 1].t_s);
}

TEST_F(OdometryModule, KeyframesKeepTheirTimeApart) {
  const auto made_s = [&](const std::string& name, const std::string& keyframe) {
    std::string yaml = kQuick;
    yaml.replace(yaml.find("distance: 0.05"), 14, keyframe);
    (void)run_odometry(request(name, yaml));
    std::vector<double> times_s;
    for (const auto& row : read_keyframe_list(folder_.path() / name / "keyframes.yaml"))
      times_s.push_back(row.made_s);
    return times_s;
  };
  const std::vector<double> any = made_s("any", "distance: 0.02, interval_s: 0");
  const std::vector<double> apart = made_s("apart", "distance: 0.02, interval_s: 0.1");
  ASSERT_GE(apart.size(), 3U);
  EXPECT_GT(any.size(), apart.size());
  // A quarter of the time that is known, at the start, and 0.1 s later.
  for (std::size_t i = 2; i < apart.size(); ++i)
    EXPECT_GE(apart[i] - apart[i - 1], std::min(0.1, apart[i] / 4) - 1e-3) << apart[i];
}

TEST_F(OdometryModule, GivenPosesMayBeStampedLate) {
  constexpr double kLate_s = 0.05;  // 40 mm of way
  std::vector<StampedPose> late = poses_until(kEnd_s);
  for (StampedPose& pose : late) pose.t_s += kLate_s;
  write_tum_trajectory(dataset() / "groundtruth.txt", late);
  const std::string known = "start: {truth_s: 0.2, truth_fraction: 0.4, time_offset_s: -0.05}";
  std::string yaml = adjusted();
  yaml.replace(yaml.find("start:"), yaml.find("\nkeyframe") - yaml.find("start:"), known);
  (void)run_odometry(request("run", yaml));
  write_poses_until(dataset(), kEnd_s);
  expect_glide(folder_.path() / "run");
}

TEST_F(OdometryModule, TheBatchAdjustmentImprovesTheWholePathAndAllKeyframes) {
  (void)run_odometry(request("before"));
  (void)run_odometry(request("after", std::string(kQuick) + "batch_adjustment: events\n"));
  const Trajectory before = read_trajectory(folder_.path() / "before" / "trajectory.txt");
  const Trajectory after = read_trajectory(folder_.path() / "after" / "trajectory.txt");
  ASSERT_EQ(after.size(), before.size());
  const auto squares_m2 = [](const Trajectory& path) {
    double sum = 0;
    for (const StampedPose& pose : path.poses())
      sum += (pose.world_from_camera.translation() - glide(pose.t_s).translation()).squaredNorm();
    return sum;
  };
  EXPECT_LT(squares_m2(after), squares_m2(before));
  EXPECT_EQ(read_covariances(folder_.path() / "after" / "covariance.txt").size(), after.size());
  for (const RunView& view : read_view_list(folder_.path() / "after" / "views.yaml")) {
    if (view.t_s < after.start_s()) continue;
    const Rigid3 off = after.at_clamped(view.t_s).inverse() * view.world_from_camera;
    EXPECT_LT(off.translation().norm(), 1e-3) << view.t_s;
  }
}

TEST_F(OdometryModule, WritesKeyframesWithTheirViews) {
  (void)run_odometry(request("run", kQuick));
  const fs::path run = folder_.path() / "run";
  const auto keyframes = read_keyframe_list(run / "keyframes.yaml");
  const auto views = read_view_list(run / "views.yaml");
  ASSERT_GE(keyframes.size(), 3U);
  ASSERT_EQ(views.size(), keyframes.size());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    EXPECT_EQ(views[i].t_s, keyframes[i].t_s);
    EXPECT_TRUE(fs::is_regular_file(views[i].depth));
    EXPECT_GT(keyframes[i].edges, 50);
    EXPECT_GE(keyframes[i].taken_s, keyframes[i].made_s);
    EXPECT_LE(keyframes[i].active.size(), 3U);
    EXPECT_EQ(keyframes[i].active.back(), static_cast<std::int64_t>(i)) << "the newest belongs";
  }
}

TEST_F(OdometryModule, LooksAtNoPoseBeyondTheStart) {
  const auto expect_none_is_read = [&](double start_s, const std::string& yaml) {
    (void)run_odometry(request("all", yaml));
    write_poses_until(dataset(), start_s);
    (void)run_odometry(request("start", yaml));
    write_poses_until(dataset(), kEnd_s);
    for (const char* file : {"trajectory.txt", "poses.csv", "map.ply"})
      EXPECT_EQ(read_file(folder_.path() / "all" / file),
                read_file(folder_.path() / "start" / file))
          << file;
  };
  expect_none_is_read(0.2, kQuick);
  // Nor where it is extrapolated.
  for (const char* run : {"all", "start"}) fs::remove_all(folder_.path() / run);
  expect_none_is_read(0.1, with_short_start());
}

TEST_F(OdometryModule, MapsBesideTrackingWithTheSameResultForAnyNumberOfThreads) {
  std::string yaml = adjusted();
  yaml.replace(yaml.find("active: 3"), 9, "active: 3, handover_s: 0.03");
  set_thread_count(1);
  (void)run_odometry(request("one", yaml));
  set_thread_count(2);
  (void)run_odometry(request("two", yaml));
  set_thread_count(0);
  for (const char* file : {"trajectory.txt", "poses.csv", "map.ply", "keyframes.yaml"})
    EXPECT_EQ(read_file(folder_.path() / "one" / file), read_file(folder_.path() / "two" / file))
        << file;
  const auto keyframes = read_keyframe_list(folder_.path() / "one" / "keyframes.yaml");
  ASSERT_GE(keyframes.size(), 2U);
  EXPECT_GE(keyframes[1].taken_s, keyframes[1].made_s + 0.03);
}

TEST_F(OdometryModule, FindsTheCameraAgainAtAKeyframe) {
  // It jumps to where it was a third of a second before: 25 px of image motion at once.
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  constexpr double kLeap_s = 0.38, kBack_s = 0.33;
  const auto leap = [](double t_s) { return glide(t_s < kLeap_s ? t_s : t_s - kBack_s); };
  Events events;
  for (const auto& [from_s, to_s] : {std::pair(0.0, kLeap_s - 1e-6), std::pair(kLeap_s, kEnd_s)}) {
    const Events some = world.simulate(leap, from_s, to_s, 1e-3, 0.12);
    events.insert(events.end(), some.begin(), some.end());
  }
  const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
  OdometryConfig config = quick();
  config.odometry.tracker.event_frame.event_map_ratio = 0.1;
  config.odometry.relocation = Relocation::kInconsistent;
  RunRequest run = request("found");
  run.dataset = folder_.path() / "leap";
  testing::write_recording(run.dataset, world.camera(), events, std::span(&blank, 1),
                           poses_until(kEnd_s));
  (void)run_odometry(run, config);
  EXPECT_THAT(read_file(run.output / "poses.csv"), HasSubstr("relocalised"));
  const CsvColumns poses(run.output / "poses.csv");
  const std::size_t t_s = poses.require("t_s");
  for (std::size_t row = 1; row < poses.rows(); ++row)
    EXPECT_GT(poses.number(row, t_s), poses.number(row - 1, t_s)) << "diverged poses are discarded";
  const Trajectory found = read_trajectory(run.output / "trajectory.txt");
  const Rigid3 error = leap(0.49).inverse() * found.at_clamped(0.49);
  EXPECT_LT(error.translation().norm(), 0.02 * kDepth_m);
  EXPECT_LT(so3_log(error.rotation()).norm(), 0.02);
}

TEST_F(OdometryModule, OnlineItSaysHowLateItIsAndWhatItDropped) {
  OdometryConfig config = quick();
  config.odometry.mode = OdometryMode::kOnline;
  config.odometry.max_age_ms = 1000;
  const RunSummary summary = run_odometry(request("online"), config);
  EXPECT_GT(summary.poses, 20U);
  const std::string timing = read_file(folder_.path() / "online" / "timing.json");
  EXPECT_THAT(timing, HasSubstr("\"latency_ms\": {\"median\""));
  EXPECT_THAT(timing, HasSubstr("\"dropped_events\": "));
}

TEST_F(OdometryModule, ThesisMakesItsMapFromTheReconstructedGradient) {
  const RunSummary summary = run_odometry(request("thesis", R"(
method: thesis
start: {truth_s: 0.3, truth_fraction: 0.6}
keyframe: {distance: 1}
)"));
  EXPECT_GT(summary.poses, 5U);
  const auto views = read_view_list(folder_.path() / "thesis" / "views.yaml");
  ASSERT_FALSE(views.empty());
  EXPECT_NEAR(views.front().t_s, 0.3, 2e-3) << "at the newest event";
  EXPECT_TRUE(fs::is_regular_file(views.front().image));
}

TEST_F(OdometryModule, TakesTheGivenStartFromAnotherFile) {
  (void)run_odometry(request("truth"));
  write_tum_trajectory(folder_.path() / "given.txt", poses_until(0.21));
  RunRequest run = request("given");
  run.poses_from = folder_.path() / "given.txt";
  (void)run_odometry(run);
  EXPECT_EQ(read_file(folder_.path() / "given" / "trajectory.txt"),
            read_file(folder_.path() / "truth" / "trajectory.txt"));
  // Nothing after the start is used, not even to smooth it.
  run.smooth_poses_s = 0.04;
  run.output = folder_.path() / "smooth";
  (void)run_odometry(run);
  run.poses_from.reset();
  run.output = folder_.path() / "smooth_truth";
  (void)run_odometry(run);
  EXPECT_EQ(read_file(folder_.path() / "smooth" / "trajectory.txt"),
            read_file(folder_.path() / "smooth_truth" / "trajectory.txt"));
  for (const double wrong : {0.0, -1.0, 1e-9, std::nan("")}) {
    run.smooth_poses_s = wrong;
    EXPECT_THAT(error_of([&] { return run_odometry(run); }), HasSubstr("--smooth-poses"));
  }
  run.smooth_poses_s.reset();
  run.poses_from = folder_.path() / "given.txt";
  write_tum_trajectory(*run.poses_from, std::vector<StampedPose>{{5, {}}, {6, {}}});
  EXPECT_THAT(error_of([&] { return run_odometry(run); }),
              AllOf(HasSubstr("given.txt"), HasSubstr("fewer than two poses")));
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2, truth_fraction: 0.4"), 33, "truth_s: 0");
  run.config = request("none", yaml).config;
  EXPECT_THAT(error_of([&] { return run_odometry(run); }), HasSubstr("--poses-from"));
}

TEST_F(OdometryModule, StartsFromEventsAndCalibrationAlone) {
  constexpr double kSteadyEnd_s = 0.4;
  const fs::path steady = folder_.path() / "steady";
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
  testing::write_recording(steady, world.camera(),
                           world.simulate(steady_glide, 0, kSteadyEnd_s, 1e-3, 0.15),
                           std::span(&blank, 1), poses_until(kSteadyEnd_s, steady_glide));
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2, truth_fraction: 0.4"), 33,
               "truth_s: 0, initial_depth_m: 2.2");
  RunRequest run = request("with", yaml);
  run.dataset = steady;
  const RunSummary summary = run_odometry(run);
  EXPECT_EQ(summary.lost_poses, 0U);
  fs::remove(steady / "groundtruth.txt");
  run.output = folder_.path() / "without";
  (void)run_odometry(run);
  for (const char* file : {"trajectory.txt", "poses.csv", "map.ply", "start.yaml"})
    EXPECT_EQ(read_file(folder_.path() / "with" / file),
              read_file(folder_.path() / "without" / file))
        << file;
  const Trajectory found = read_trajectory(folder_.path() / "with" / "trajectory.txt");
  EXPECT_LT(found.poses().front().world_from_camera.log().norm(), 0.01);
}

TEST_F(OdometryModule, RefusesAStartThatTheNextEventsDoNotLieOn) {
  // A start is found in the first quarter of a second. What follows it is noise, at the rate of the
  // events before.
  constexpr double kNoiseFrom_s = 0.27;
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  Events events = world.simulate(steady_glide, 0, kNoiseFrom_s, 1e-3, 0.15);
  const double interval_s = kNoiseFrom_s / static_cast<double>(events.size());
  const Random random(7);
  for (std::uint64_t i = 1; kNoiseFrom_s + static_cast<double>(i) * interval_s < kEnd_s; ++i)
    events.push_back({ns_from_seconds(kNoiseFrom_s + static_cast<double>(i) * interval_s),
                      static_cast<std::uint16_t>(160 * random.uniform(i, 0)),
                      static_cast<std::uint16_t>(120 * random.uniform(i, 1)),
                      static_cast<std::int8_t>(random.uniform(i, 2) < 0.5 ? 1 : -1)});
  const testing::StampedPicture blank{0, ImageU8(world.camera().width, world.camera().height)};
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2, truth_fraction: 0.4"), 33,
               "truth_s: 0, initial_depth_m: 2.2");
  RunRequest run = request("noise", yaml);
  run.dataset = folder_.path() / "noisy";
  testing::write_recording(run.dataset, world.camera(), events, std::span(&blank, 1),
                           poses_until(kEnd_s, steady_glide));
  EXPECT_THAT(error_of([&] { return run_odometry(run); }),
              HasSubstr("does not explain the events after it"));
  EXPECT_FALSE(fs::exists(run.output));
}

TEST_F(OdometryModule, TheMethodSetsTheDefaults) {
  const auto read = [](const std::string& yaml) {
    return config::read<OdometryConfig>(config::parse(yaml, "configuration"));
  };
  const auto printed = [&](const std::string& yaml) {
    return config::print_documented(read(yaml));
  };
  const std::string thesis = printed("method: thesis\nmapping: {events: 100000}\n");
  EXPECT_EQ(read(thesis).odometry.relocation, Relocation::kNever);
  EXPECT_EQ(read("{}").odometry.relocation, Relocation::kLost);
  EXPECT_THAT(thesis, HasSubstr("events: 100000"));
  EXPECT_EQ(printed("{}"), printed("method: edges")) << "the default";
  EXPECT_THAT(printed("{}"), HasSubstr("active: 3"));
  EXPECT_EQ(printed(thesis), thesis) << "a run's own configuration reads back";
}

TEST_F(OdometryModule, SaysWhatIsWrong) {
  fs::remove(dataset() / "groundtruth.txt");
  EXPECT_THAT(error_of([&] { return run_odometry(request("none")); }), HasSubstr("start.truth_s"));
  write_poses_until(dataset(), kEnd_s);
  const std::string thesis = "method: thesis\nadjustment: {rounds: 1}\n";
  EXPECT_THAT(error_of([&] { return run_odometry(request("thesis", thesis)); }),
              HasSubstr("adjustment"));
}

}  // namespace
}  // namespace saccade
