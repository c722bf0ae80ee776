#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/run/keyframe_list.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"
#include "core/random.h"
#include "estimator/odometry/odometry_module.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/support/recording.h"
#include "tests/unit/estimator/odometry/glide.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::adjusted;
using testing::error_of;
using testing::expect_glide;
using testing::glide;
using ::testing::HasSubstr;
using testing::kDepth_m;
using testing::kEnd_s;
using testing::kQuick;
using ::testing::Not;
using testing::OdometryModule;
using testing::poses_until;
using testing::read_file;
using testing::steady_glide;
using testing::with_short_start;
using testing::write_poses_until;

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

/// adjusted(), without a given pose.
std::string without_poses() {
  std::string yaml = adjusted();
  yaml.replace(yaml.find("truth_s: 0.2, truth_fraction: 0.4"), 33,
               "truth_s: 0, initial_depth_m: 2.2");
  return yaml;
}

/// A recording of steady_glide() until `steady_s`, whatever its events are later.
void write_steady(const fs::path& folder, std::span<const Event> events, double steady_s) {
  const PinholeCamera camera = testing::corner_world(160, 120).camera();
  const testing::StampedPicture blank{0, ImageU8(camera.width, camera.height)};
  testing::write_recording(folder, camera, events, std::span(&blank, 1),
                           poses_until(steady_s, steady_glide));
}

TEST_F(OdometryModule, StartsFromEventsAndCalibrationAlone) {
  constexpr double kSteadyEnd_s = 0.4;
  const fs::path steady = folder_.path() / "steady";
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  write_steady(steady, world.simulate(steady_glide, 0, kSteadyEnd_s, 1e-3, 0.15), kSteadyEnd_s);
  RunRequest run = request("with", without_poses());
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

TEST_F(OdometryModule, RefusesAStartThatNoPoseFollows) {
  // The camera stops, and a single event comes a second later: nothing tells whether it was right.
  constexpr double kStop_s = 0.249;
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  Events events = world.simulate(steady_glide, 0, kStop_s, 1e-3, 0.15);
  events.push_back({ns_from_seconds(kStop_s + 1), 20, 30, 1});
  RunRequest run = request("stop", without_poses());
  run.dataset = folder_.path() / "stop_data";
  write_steady(run.dataset, events, kStop_s);
  EXPECT_THAT(error_of([&] { return run_odometry(run); }),
              HasSubstr("no pose follows the start that was found at"));
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
  RunRequest run = request("noise", without_poses());
  run.dataset = folder_.path() / "noisy";
  write_steady(run.dataset, events, kEnd_s);
  EXPECT_THAT(error_of([&] { return run_odometry(run); }),
              HasSubstr("does not explain the events after it"));
  EXPECT_FALSE(fs::exists(run.output));
}

TEST_F(OdometryModule, LooksForAnotherStartWhereOneFailsItsTrial) {
  // Until then the picture is mirrored: the camera seems to move the other way, and nothing of what
  // is mapped is seen again.
  constexpr double kMirroredUntil_s = 0.27, kLongEnd_s = 0.7;
  const testing::PlanarWorld world = testing::corner_world(160, 120);
  Events events = world.simulate(steady_glide, 0, kLongEnd_s, 1e-3, 0.15);
  for (Event& event : events)
    if (seconds_from_ns(event.t_ns) < kMirroredUntil_s)
      event.x = static_cast<std::uint16_t>(159 - event.x);
  RunRequest run = request("mirrored", without_poses());
  run.dataset = folder_.path() / "mirrored_data";
  write_steady(run.dataset, events, kLongEnd_s);
  ::testing::internal::CaptureStderr();
  const RunSummary summary = run_odometry(run);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("does not explain the events after it (probability"));
  const Trajectory found = read_trajectory(run.output / "trajectory.txt");
  EXPECT_GT(found.start_s(), 0.1);
  EXPECT_LT(found.start_s(), kLongEnd_s / 2);
  EXPECT_GT(found.end_s(), kLongEnd_s - 0.05);
  // A start at another time has an origin of its own, but the turn is the same; that of the mirrored
  // picture would be the other way.
  const double from_s = kMirroredUntil_s + 0.1, until_s = 0.65;
  const auto turn = [](const Rigid3& before, const Rigid3& after) {
    return (before.inverse() * after).rotation();
  };
  const Eigen::Quaterniond truly = turn(steady_glide(from_s), steady_glide(until_s));
  const Eigen::Quaterniond turned = turn(found.at_clamped(from_s), found.at_clamped(until_s));
  EXPECT_LT(so3_log(turned.conjugate() * truly).norm(), 0.5 * so3_log(truly).norm());
  // A pose every millisecond: but for the mirrored ones none is lost.
  EXPECT_LT(static_cast<double>(summary.lost_poses),
            1e3 * std::max(0.0, kMirroredUntil_s - found.start_s()) + 20);
}

}  // namespace
}  // namespace saccade
