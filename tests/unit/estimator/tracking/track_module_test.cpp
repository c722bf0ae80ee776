#include "estimator/tracking/track_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/io/images/image_file.h"
#include "core/io/imu_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/run_record.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"
#include "core/srgb.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/support/recording.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::PlanarWorld;
using testing::read_file;
using testing::TemporaryFolder;

constexpr double kDepth_m = 1.5;
constexpr double kWallEnd_s = 0.4;

/// One textured wall at kDepth_m that fills the view of a small camera.
PlanarWorld wall() { return testing::wall_world(80, 60, 66, kDepth_m, 210, 158); }

Rigid3 motion(double t_s) {
  return {so3_exp({0, 0, 0.15 * t_s}), {0.3 * t_s, 0.1 * std::sin(8 * t_s), 0.05 * t_s}};
}

ImageU8 picture_of(const PlanarWorld& world, const Rigid3& pose) {
  ImageF radiance = world.log_intensity(pose);
  for (float& value : radiance.pixels()) value = std::exp(value) - 1e-3F;
  return srgb8_from_linear(radiance);
}

void write_wall(const fs::path& folder) {
  const PlanarWorld world = wall();
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 400; ++i) poses.push_back({i * 1e-3, motion(i * 1e-3)});
  const testing::StampedPicture pictures[] = {{0, picture_of(world, motion(0))},
                                              {0.2, picture_of(world, motion(0.2))}};
  testing::write_recording(folder, world.camera(),
                           world.simulate(motion, 0, kWallEnd_s, 2e-3, 0.12), pictures, poses);
}

/// RMS distance of points of the wall all over the view between a pose and the true one [px].
double error_px(const Rigid3& world_from_camera, double t_s) {
  const PinholeCamera camera = wall().camera();
  double squared = 0;
  double count = 0;
  for (int y = 5; y < camera.height; y += 10)
    for (int x = 5; x < camera.width; x += 10, ++count) {
      const Eigen::Vector3d point = kDepth_m * camera.ray({x, y});
      squared += (camera.project(world_from_camera.inverse() * point) -
                  camera.project(motion(t_s).inverse() * point))
                     .squaredNorm();
    }
  return std::sqrt(squared / count);
}

class TrackModule : public ::testing::Test {
 protected:
  TrackModule() { write_wall(dataset_); }

  [[nodiscard]] RunRequest request(const std::string& name,
                                   const std::string& yaml = "reference: {planar_depth_m: 1.5}") {
    return testing::run_request(dataset_, folder_.path() / name, yaml);
  }

  [[nodiscard]] std::string error(const RunRequest& request) {
    const std::string message = error_of([&] { return run_track(request); });
    EXPECT_FALSE(fs::exists(request.output)) << "a failed run leaves nothing";
    return message;
  }

  void remove(const std::string& name) { fs::remove_all(dataset_ / name); }

  TemporaryFolder folder_;
  const fs::path dataset_ = folder_.path() / "wall";
};

TEST_F(TrackModule, WritesACompleteRunFolder) {
  const RunSummary summary = run_track(request("run"));
  const fs::path run = folder_.path() / "run";
  for (const char* name : {"trajectory.txt", "poses.csv", "map.ply", "run.yaml", "timing.json"})
    EXPECT_TRUE(fs::is_regular_file(run / name)) << name;
  EXPECT_GT(summary.events, 1000U);
  EXPECT_GT(summary.poses, 10U);
  EXPECT_EQ(summary.lost_poses, 0U);
  const CsvColumns poses(run / "poses.csv");
  ASSERT_EQ(poses.rows(), summary.poses);
  for (std::size_t i = 0; i < poses.rows(); ++i) {
    EXPECT_EQ(poses.text(i, poses.require("status")), "ok");
    EXPECT_LE(poses.number(i, poses.require("first_event_s")),
              poses.number(i, poses.require("t_s")));
    EXPECT_LE(poses.number(i, poses.require("t_s")),
              poses.number(i, poses.require("last_event_s")));
    EXPECT_GT(poses.number(i, poses.require("inlier_ratio")), 0.5);
  }
  EXPECT_THAT(read_file(run / "run.yaml"), HasSubstr("track"));
  EXPECT_THAT(read_file(run / "run.yaml"), HasSubstr("planar_depth_m: 1.5"));
  EXPECT_THAT(read_file(run / "timing.json"), HasSubstr("align"));
}

TEST_F(TrackModule, FollowsTheTrueMotion) {
  static_cast<void>(run_track(request("run")));
  const Trajectory trajectory = read_tum_trajectory(folder_.path() / "run/trajectory.txt");
  ASSERT_GT(trajectory.size(), 10U);
  EXPECT_GT(error_px({}, kWallEnd_s), 4) << "the camera must move";
  for (const StampedPose& pose : trajectory.poses())
    EXPECT_LT(error_px(pose.world_from_camera, pose.t_s), 1.5) << pose.t_s;
}

TEST_F(TrackModule, MapLiesOnTheWallInWorldCoordinates) {
  static_cast<void>(run_track(request("run", "reference: {planar_depth_m: 1.5, frame: 1}")));
  const PointCloud map = read_ply(folder_.path() / "run/map.ply");
  ASSERT_GT(map.positions.size(), 100U);
  const Rigid3 camera_from_world = motion(0.2).inverse();
  for (const Eigen::Vector3f& point : map.positions)
    EXPECT_NEAR((camera_from_world * point.cast<double>()).z(), kDepth_m, 1e-4);
}

TEST_F(TrackModule, RegionLimitsTheMap) {
  static_cast<void>(run_track(
      request("run", "reference: {planar_depth_m: 1.5, frame: 0, region_px: [10, 5, 60, 50]}")));
  const PointCloud map = read_ply(folder_.path() / "run/map.ply");
  ASSERT_GT(map.positions.size(), 50U);
  for (const Eigen::Vector3f& point : map.positions) {
    const Eigen::Vector2d u = wall().camera().project(point.cast<double>());
    EXPECT_TRUE(u.x() > 9 && u.x() < 61 && u.y() > 4 && u.y() < 51) << u.transpose();
  }
}

TEST_F(TrackModule, OutputDependsOnTheSeedAlone) {
  RunRequest again = request("b");
  again.threads = 4;
  again.repeat = 2;
  RunRequest other = request("c");
  other.seed = 99;
  static_cast<void>(run_track(request("a")));
  static_cast<void>(run_track(again));
  static_cast<void>(run_track(other));
  for (const char* name : {"trajectory.txt", "poses.csv", "map.ply"})
    EXPECT_EQ(read_file(folder_.path() / "a" / name), read_file(folder_.path() / "b" / name))
        << name;
  EXPECT_NE(read_file(folder_.path() / "a/trajectory.txt"),
            read_file(folder_.path() / "c/trajectory.txt"));
  EXPECT_THAT(read_file(folder_.path() / "c/run.yaml"), HasSubstr("seed: 99"));
}

TEST_F(TrackModule, TracksTheWindowThatIsAskedFor) {
  RunRequest part = request("run");
  part.start_s = 0.1;
  part.duration_s = 0.15;
  static_cast<void>(run_track(part));
  const CsvColumns poses(folder_.path() / "run/poses.csv");
  ASSERT_GT(poses.rows(), 3U);
  EXPECT_GE(poses.number(0, poses.require("first_event_s")), 0.1);
  EXPECT_LT(poses.number(poses.rows() - 1, poses.require("last_event_s")), 0.25);
}

TEST_F(TrackModule, InitialPoseReplacesTheTruth) {
  remove("groundtruth.txt");
  static_cast<void>(run_track(
      request("run", "{reference: {planar_depth_m: 1.5}, initial_pose: [0, 0, 0, 0, 0, 0, 1]}")));
  EXPECT_EQ(read_tum_trajectory(folder_.path() / "run/trajectory.txt").size(),
            CsvColumns(folder_.path() / "run/poses.csv").rows());
}

TEST_F(TrackModule, AWrongCalibrationIsCorrected) {
  (void)run_track(request("right"));
  folder_.write("wall/calib.txt", "132 132 39.5 29.5 0 0 0 0 0\n");
  (void)run_track(
      request("corrected", "{reference: {planar_depth_m: 1.5}, camera: {focal_scale: 0.5}}"));
  EXPECT_EQ(read_file(folder_.path() / "right/trajectory.txt"),
            read_file(folder_.path() / "corrected/trajectory.txt"));
}

TEST_F(TrackModule, WithoutDepthNamesTheCure) {
  EXPECT_THAT(error(request("run", "{}")), HasSubstr("reference.planar_depth_m"));
}

TEST_F(TrackModule, TurnsByTheGyroscopeOfTheDataset) {
  const std::string config = "{reference: {planar_depth_m: 1.5}, motion: {prediction: imu}}";
  EXPECT_THAT(error(request("run", config)), HasSubstr("imu.txt"));
  std::vector<ImuSample> samples;
  for (int i = 0; i <= 400; ++i) {
    ImuSample sample;
    sample.t_ns = 1'000'000 * i;
    sample.angular_velocity = {0.15, 0, 0};  // the camera's z is the sensor's x
    samples.push_back(sample);
  }
  write_imu(dataset_ / "imu.txt", samples);
  folder_.write("wall/camera.yaml",
                "cam0:\n  resolution: [80, 60]\n  intrinsics: [66, 66, 39.5, 29.5]\n"
                "  camera_model: pinhole\n  distortion_model: radtan\n"
                "  distortion_coeffs: [0, 0, 0, 0]\n"
                "  T_cam_imu: [[0, 1, 0, 0], [0, 0, 1, 0], [1, 0, 0, 0], [0, 0, 0, 1]]\n");
  const RunSummary summary = run_track(request("turned", config));
  EXPECT_GT(summary.poses, 20U);
  EXPECT_EQ(summary.lost_poses, 0U);
}

TEST_F(TrackModule, FollowsTheTrueMotionByLogIntensity) {
  const RunSummary summary = run_track(
      request("run",
              "{method: intensity, reference: {planar_depth_m: 1.5}, intensity: {events: 500, "
              "contrast_on: 0.12, contrast_off: 0.12}, motion: {prediction: constant_velocity}}"));
  EXPECT_EQ(summary.poses, summary.events / 500);
  EXPECT_EQ(summary.lost_poses, 0U);
  const Trajectory trajectory = read_tum_trajectory(folder_.path() / "run/trajectory.txt");
  for (const StampedPose& pose : trajectory.poses())
    EXPECT_LT(error_px(pose.world_from_camera, pose.t_s), 0.8) << pose.t_s;
}

TEST_F(TrackModule, FollowsTheTrueMotionByPolarityWithoutAContrast) {
  const RunSummary summary = run_track(
      request("run",
              "{method: polarity, reference: {planar_depth_m: 1.5}, polarity: {events: 1000}, "
              "motion: {prediction: constant_velocity}}"));
  EXPECT_GT(summary.poses, 20U);
  EXPECT_EQ(summary.lost_poses, 0U);
  const Trajectory trajectory = read_tum_trajectory(folder_.path() / "run/trajectory.txt");
  // Until then the velocity, and with it the expected increments, is not known yet.
  constexpr double kVelocityKnown_s = 0.05;
  for (const StampedPose& pose : trajectory.poses())
    EXPECT_LT(error_px(pose.world_from_camera, pose.t_s), pose.t_s < kVelocityKnown_s ? 3 : 1.5)
        << pose.t_s;
}

TEST_F(TrackModule, FindsAContrastThatNobodyStatesAndSaysSo) {
  const RunSummary summary = run_track(
      request("found",
              "{method: intensity, reference: {planar_depth_m: 1.5}, motion: {prediction: "
              "constant_velocity}}"));
  EXPECT_EQ(summary.lost_poses, 0U);
  EXPECT_THAT(summary.found, HasSubstr("contrast thresholds 0."));
  const RunRecord record = read_run_record(folder_.path() / "found/run.yaml");
  ASSERT_TRUE(record.contrast);
  EXPECT_NEAR(record.contrast->on, 0.12, 0.04);
  EXPECT_NEAR(record.contrast->off, 0.12, 0.04);
}

TEST_F(TrackModule, FramesJoinTheMapWhereTheViewHasTurned) {
  // The second frame is turned by 1.7 degrees.
  const auto points = [&](const std::string& name, const std::string& new_view_deg) {
    static_cast<void>(run_track(request(
        name, "reference: {frame: 0, planar_depth_m: 1.5, new_view_deg: " + new_view_deg + "}")));
    const PointCloud map = read_ply(folder_.path() / name / "map.ply");
    for (const Eigen::Vector3f& point : map.positions)
      EXPECT_NEAR(point.z(), kDepth_m, 0.02) << "both are taken for planes at this depth";
    return map.positions.size();
  };
  const std::size_t one = points("one", "~");
  EXPECT_EQ(points("still_one", "3"), one);
  EXPECT_GT(points("two", "1"), one * 3 / 2);
}

TEST_F(TrackModule, FurtherFramesNeedTheTruth) {
  remove("groundtruth.txt");
  EXPECT_THAT(error(request("run",
                            "{reference: {planar_depth_m: 1.5, new_view_deg: 1}, initial_pose: "
                            "[0, 0, 0, 0, 0, 0, 1]}")),
              HasSubstr("new_view_deg"));
}

TEST_F(TrackModule, WithoutTruthNamesTheCure) {
  remove("groundtruth.txt");
  EXPECT_THAT(error(request("run")), HasSubstr("initial_pose"));
}

TEST_F(TrackModule, InitialPoseMustHoldAUnitQuaternion) {
  EXPECT_THAT(error(request("run",
                            "{reference: {planar_depth_m: 1.5}, initial_pose: [0, 0, 0, 0, "
                            "0, 0, 2]}")),
              HasSubstr("initial_pose"));
}

TEST_F(TrackModule, WithoutFramesNamesTheCure) {
  remove("images.txt");
  folder_.write("wall/camera.yaml",
                "cam0:\n  resolution: [80, 60]\n  intrinsics: [66, 66, 39.5, 29.5]\n"
                "  camera_model: pinhole\n  distortion_model: radtan\n"
                "  distortion_coeffs: [0, 0, 0, 0]\n");
  EXPECT_THAT(error(request("run")), HasSubstr("images.txt"));
}

TEST_F(TrackModule, AFrameThatIsNotThere) {
  EXPECT_THAT(error(request("run", "reference: {planar_depth_m: 1.5, frame: 7}")),
              HasSubstr("reference.frame"));
  RunRequest late = request("run");
  late.start_s = 0.3;
  EXPECT_THAT(error(late), HasSubstr("no frame at or after the start"));
  remove("images/0.png");
  EXPECT_THAT(error(request("run", "reference: {planar_depth_m: 1.5, frame: 0}")),
              HasSubstr("0.png"));
}

TEST_F(TrackModule, AWindowWithoutEvents) {
  RunRequest late = request("run");
  late.start_s = 5;
  EXPECT_THAT(error(late), HasSubstr("no events in the window"));
  folder_.write("wall/events.txt", "");
  EXPECT_THAT(error(request("run")), HasSubstr("event"));
}

TEST_F(TrackModule, FramesAreTrackedWithoutAnyEvents) {
  remove("events.txt");
  const std::string frames =
      "{method: frames, reference: {planar_depth_m: 1.5}, motion: "
      "{prediction: constant_velocity}}";
  const RunSummary summary = run_track(request("run", frames));
  EXPECT_EQ(summary.poses, 2U);
  EXPECT_EQ(summary.lost_poses, 0U);
  EXPECT_EQ(summary.events, 0U);
  const Trajectory trajectory = read_tum_trajectory(folder_.path() / "run/trajectory.txt");
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory.poses()[1].t_s, 0.2);
  EXPECT_GT(error_px({}, 0.2), 3) << "the camera must move";
  for (const StampedPose& pose : trajectory.poses())
    EXPECT_LT(error_px(pose.world_from_camera, pose.t_s), 0.2) << pose.t_s;
}

TEST_F(TrackModule, AWindowWithoutFrames) {
  RunRequest late = request("run", "{method: frames, reference: {planar_depth_m: 1.5}}");
  late.start_s = 0.25;
  EXPECT_THAT(error(late), HasSubstr("no frames in the window"));
  folder_.write("wall/images.txt", "0 images/0.png\n0.2 images/missing.png\n");
  EXPECT_THAT(error(request("run", "{method: frames, reference: {planar_depth_m: 1.5}}")),
              HasSubstr("missing.png"));
}

TEST_F(TrackModule, AnEmptyMapIsLostTracking) {
  // A frame without texture is input that can be read: the poses say that it did not work.
  write_png(dataset_ / "images/0.png", ImageU8(80, 60, 128));
  const RunSummary summary =
      run_track(request("run", "{reference: {planar_depth_m: 1.5, frame: 0}}"));
  EXPECT_GT(summary.poses, 0U);
  EXPECT_EQ(summary.lost_poses, summary.poses);
}

TEST_F(TrackModule, TooFewEventsForAFrameStillMakeARun) {
  RunRequest part =
      request("run", "{reference: {planar_depth_m: 1.5}, edges: {event_map_ratio: 100}}");
  const RunSummary summary = run_track(part);
  EXPECT_EQ(summary.poses, 0U);
  EXPECT_TRUE(fs::exists(folder_.path() / "run/run.yaml"));
}

}  // namespace
}  // namespace saccade
