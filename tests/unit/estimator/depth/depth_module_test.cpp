#include "estimator/depth/depth_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/run_record.h"
#include "core/io/run/view_list.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/random.h"
#include "estimator/registry.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/fake_run.h"
#include "tests/support/planar_world.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;

class DepthModule : public testing::SharedFolder<DepthModule> {
 public:
  static void fill() { testing::write_corner_dataset(dataset(), "corner", 0.25, 120); }

 protected:
  [[nodiscard]] static fs::path dataset() { return path("corner"); }
  [[nodiscard]] static RunRequest request(const std::string& name,
                                          const std::string& yaml = "window: {duration_s: 0.13}") {
    return testing::run_request(dataset(), path(name), yaml);
  }
};

TEST_F(DepthModule, WritesACompleteRunFolder) {
  const RunSummary summary = run_depth(request("run"));
  EXPECT_THAT(summary.found, HasSubstr("in 2 views"));
  const auto points = static_cast<std::size_t>(std::stoi(summary.found));
  EXPECT_GT(points, 100U);
  for (const char* name : {"run.yaml", "timing.json", "views.yaml", "cloud.ply"})
    EXPECT_TRUE(fs::exists(path("run") / name)) << name;
  EXPECT_THAT(read_file(path("run") / "run.yaml"), HasSubstr("module: depth"));

  const auto views = read_view_list(path("run") / "views.yaml");
  ASSERT_EQ(views.size(), 2U);
  const PointCloud cloud = read_ply(path("run") / "cloud.ply");
  EXPECT_EQ(cloud.positions.size(), points);
  std::size_t pixels = 0;
  for (const RunView& view : views) {
    const Rigid3 truth = testing::corner_motion(view.t_s);
    EXPECT_LT((view.world_from_camera.translation() - truth.translation()).norm(), 1e-5);
    EXPECT_LE(view.start_s, view.end_s);
    EXPECT_EQ(read_image_rgb(view.keypoints).width(), 360);
    const auto channels = read_exr_channels(view.depth);
    ASSERT_EQ(channels.size(), 2U);
    EXPECT_EQ(channels[0].name, "Z");
    EXPECT_EQ(channels[1].name, "variance");
    for (std::size_t i = 0; i < channels[0].image.size(); ++i) {
      const bool known = channels[0].image.pixels()[i] > 0;
      EXPECT_EQ(known, channels[1].image.pixels()[i] > 0);
      pixels += known ? 1 : 0;
    }
  }
  EXPECT_LE(pixels, points) << "two points may share a pixel";
  EXPECT_GT(pixels, points * 8 / 10);
}

TEST_F(DepthModule, WindowsOfLittleParallaxAreJoined) {
  EXPECT_THAT(run_depth(request("apart", "window: {duration_s: 0.06}")).found,
              HasSubstr("in 5 views"));
  EXPECT_THAT(run_depth(request("joined", "window: {duration_s: 0.06, parallax_px: 1000}")).found,
              HasSubstr("in 1 views"));
}

TEST_F(DepthModule, TheCloudLiesInTheWorldWhereTheViewsSeeIt) {
  run_depth(request("cloud"));
  const auto views = read_view_list(path("cloud") / "views.yaml");
  const PointCloud cloud = read_ply(path("cloud") / "cloud.ply");
  ASSERT_EQ(cloud.scalars.size(), 5U);
  const PinholeCamera camera = Dataset::open(dataset()).camera();
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const RunView& view = views[static_cast<std::size_t>(cloud.scalars[0].values[i])];
    const Eigen::Vector3d point =
        view.world_from_camera.inverse() * cloud.positions[i].cast<double>();
    const Eigen::Vector2d pixel(cloud.scalars[1].values[i], cloud.scalars[2].values[i]);
    EXPECT_LT((camera.project(point) - pixel).norm(), 1e-2);
    EXPECT_NEAR(point.z(), static_cast<double>(cloud.scalars[3].values[i]), 1e-4);
  }
}

TEST_F(DepthModule, GivesTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  run_depth(request("one"));
  set_thread_count(3);
  run_depth(request("three"));
  set_thread_count(0);
  for (const char* name : {"cloud.ply", "views.yaml", "depth/depth_00000001.exr"})
    EXPECT_EQ(read_file(path("one") / name), read_file(path("three") / name)) << name;
}

TEST_F(DepthModule, TakesPosesFromARunOrAFile) {
  run_depth(request("truth"));
  const Trajectory truth = Dataset::open(dataset()).groundtruth();
  fs::create_directories(path("tracked"));
  write_tum_trajectory(path("tracked") / "trajectory.txt", truth.poses());
  for (const fs::path& from : {path("tracked"), path("tracked") / "trajectory.txt"}) {
    RunRequest other = request("other");
    other.poses_from = from;
    run_depth(other);
    EXPECT_EQ(read_file(path("other") / "cloud.ply"), read_file(path("truth") / "cloud.ply"));
  }
  // Twice the translation is twice the depth.
  std::vector<StampedPose> doubled(truth.poses().begin(), truth.poses().end());
  for (StampedPose& pose : doubled)
    pose.world_from_camera = {pose.world_from_camera.rotation(),
                              2 * pose.world_from_camera.translation()};
  write_tum_trajectory(path("doubled.txt"), doubled);
  RunRequest other =
      request("doubled", "{window: {duration_s: 0.3}, thesis: {initial_depth_m: 5}}");
  other.poses_from = path("doubled.txt");
  run_depth(other);
  run_depth(request("plain", "{window: {duration_s: 0.3}, thesis: {initial_depth_m: 2.5}}"));
  const auto median_depth = [&](const std::string& run) {
    auto depths = read_ply(path(run) / "cloud.ply").scalars[3].values;
    std::sort(depths.begin(), depths.end());
    return static_cast<double>(depths[depths.size() / 2]);
  };
  EXPECT_NEAR(median_depth("doubled") / median_depth("plain"), 2, 0.06);
}

TEST_F(DepthModule, SmoothsPosesOnRequestAndSaysThatTheyJitter) {
  const Random random(5);
  const Trajectory truth = Dataset::open(dataset()).groundtruth();
  std::vector<StampedPose> noisy;
  for (std::size_t i = 0; i < truth.size(); i += 5) {
    StampedPose pose = truth.poses()[i];
    const Eigen::Vector3d turn(random.normal(0, 3 * i), random.normal(0, 3 * i + 1),
                               random.normal(0, 3 * i + 2));
    pose.world_from_camera = {pose.world_from_camera.rotation() * so3_exp(4e-3 * turn),
                              pose.world_from_camera.translation()};
    noisy.push_back(pose);
  }
  write_tum_trajectory(path("noisy.txt"), noisy);
  RunRequest run = request("noisy", "method: rays");
  set_progress_quiet(false);
  run.poses_from = path("noisy.txt");
  ::testing::internal::CaptureStderr();
  run_depth(run);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("jitter by 4"));
  const auto points_of = [](const fs::path& folder) {
    return read_ply(folder / "cloud.ply").positions.size();
  };
  run.smooth_poses_s = 0.04;
  run.output = path("smooth");
  ::testing::internal::CaptureStderr();
  run_depth(run);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Not(HasSubstr("jitter")));
  EXPECT_GT(points_of(path("smooth")), 100U);
  EXPECT_NE(read_file(path("smooth") / "cloud.ply"), read_file(path("noisy") / "cloud.ply"));
  EXPECT_EQ(read_run_record(path("smooth") / "run.yaml").smooth_poses_s, 0.04);
}

TEST_F(DepthModule, LeavesOutEventsWithoutPoses) {
  const Trajectory truth = Dataset::open(dataset()).groundtruth();
  write_tum_trajectory(path("part.txt"), truth.poses().subspan(50, 101));
  RunRequest part = request("part", "");
  part.poses_from = path("part.txt");
  run_depth(part);
  const auto views = read_view_list(path("part") / "views.yaml");
  EXPECT_GE(views.front().start_s, 0.05 - 1e-9);
  EXPECT_LE(views.back().end_s, 0.15 + 1e-9);
  EXPECT_EQ(read_run_record(path("part") / "run.yaml").poses_from, path("part.txt"));
}

TEST_F(DepthModule, SaysWhatIsMissing) {
  RunRequest absent = request("absent");
  absent.poses_from = path("nowhere");
  EXPECT_THAT(error_of([&] { return run_depth(absent); }), HasSubstr("nowhere"));
  write_tum_trajectory(path("late.txt"), std::vector<StampedPose>{{9, {}}, {10, {}}});
  absent.poses_from = path("late.txt");
  EXPECT_THAT(error_of([&] { return run_depth(absent); }), HasSubstr("time of the poses"));
  RunRequest empty = request("empty");
  empty.start_s = 5;
  EXPECT_THAT(error_of([&] { return run_depth(empty); }), HasSubstr("no events"));
  EXPECT_FALSE(fs::exists(path("absent")));
  EXPECT_FALSE(fs::exists(path("empty")));
}

TEST_F(DepthModule, TrackingTakesNoPoses) {
  RunRequest track = request("track", "");
  track.poses_from = path("late.txt");
  EXPECT_THAT(error_of([&] { return run_module("track", track); }), HasSubstr("--poses-from"));
  track.poses_from.reset();
  track.smooth_poses_s = 0.04;
  EXPECT_THAT(error_of([&] { return run_module("track", track); }), HasSubstr("--smooth-poses"));
}

}  // namespace
}  // namespace saccade
