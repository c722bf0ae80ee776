#include "core/io/import/public_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/fisheye_camera.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/events_h5.h"
#include "core/io/images/image_file.h"
#include "core/process/progress.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// An event each millisecond from `start_s` on.
Events some_events(double start_s, int count, int width, int height) {
  Events events;
  for (int i = 0; i < count; ++i)
    events.push_back({ns_from_seconds(start_s) + i * 1'000'000,
                      static_cast<std::uint16_t>(i % width), static_cast<std::uint16_t>(i % height),
                      static_cast<std::int8_t>(i % 2 == 0 ? 1 : -1)});
  return events;
}

void write_h5(const fs::path& file, const Events& events) {
  fs::create_directories(file.parent_path());
  EventH5Writer writer(file, TimestampUnit::kMicroseconds);
  writer.append(events);
  writer.close();
}

// DSEC: a plane at 8 m before the rectified camera, focal length 100 px, baseline 0.5 m: disparity
// 100 * 0.5 / 8 = 6.25 px.
void write_dsec(const TemporaryFolder& folder) {
  write_h5(folder.path() / "events/left/events.h5", some_events(50000.5, 2000, 64, 48));
  folder.write("calibration/cam_to_cam.yaml",
               "extrinsics:\n"
               "  R_rect0: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"
               "  T_10: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n"
               "intrinsics:\n"
               "  cam0: {camera_matrix: [100, 100, 31.5, 23.5], camera_model: pinhole,\n"
               "         distortion_coeffs: [-0.1, 0.02, 0, 0], distortion_model: radtan,\n"
               "         resolution: [64, 48]}\n"
               "  camRect0: {camera_matrix: [100, 100, 31.5, 23.5], resolution: [64, 48]}\n"
               "disparity_to_depth:\n"
               "  cams_03: [[1, 0, 0, -31.5], [0, 1, 0, -23.5], [0, 0, 0, 100], [0, 0, 2, 0]]\n");
  folder.write("disparity/timestamps.txt", "50001000000\n50001100000\n");
  fs::create_directories(folder.path() / "disparity/event");
  for (const char* name : {"000000.png", "000002.png"})
    folder.write(fs::path("disparity/event") / name, encode_png(ImageU16(64, 48, 6.25 * 256)));
}

TEST(Dsec, BecomesADatasetWithDepthInTheRawView) {
  const TemporaryFolder folder;
  write_dsec(folder);
  set_progress_quiet(true);
  const auto sequence = open_public_sequence(folder.path());
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->layout, "DSEC");
  const TemporaryFolder out;
  EXPECT_EQ(write_as_dataset(*sequence, out.path() / "data").events, 2000U);
  const Dataset dataset = Dataset::open(out.path() / "data");
  EXPECT_EQ(dataset.load_events(), some_events(50000.5, 2000, 64, 48));
  EXPECT_EQ(dataset.camera().width, 64);
  EXPECT_EQ(dataset.camera().distortion[0], -0.1);
  EXPECT_TRUE(dataset.groundtruth().empty());
  ASSERT_EQ(dataset.depth_maps().size(), 2U);
  EXPECT_NEAR(dataset.depth_maps()[1].t_s, 50001.1, 1e-6);
  const ImageF depth = dataset.load_depth(0);
  EXPECT_FLOAT_EQ(depth(31, 23), 8);
  EXPECT_NEAR(*dataset.facts().mean_depth_m, 8, 1e-5);
}

TEST(Dsec, TakesAPartOfTheSequence) {
  const TemporaryFolder folder;
  write_dsec(folder);
  const TemporaryFolder out;
  const auto sequence = open_public_sequence(folder.path());
  EXPECT_EQ(write_as_dataset(*sequence, out.path() / "data", {0.55, 0.2}).events, 200U);
  EXPECT_EQ(Dataset::open(out.path() / "data").depth_maps().size(), 1U);
}

TEST(Dsec, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  write_dsec(folder);
  folder.write("disparity/timestamps.txt", "50001000000\n");
  EXPECT_THAT(error_of([&] { return open_public_sequence(folder.path()).has_value(); }),
              HasSubstr("1 times for 2 pictures"));
  fs::remove(folder.path() / "calibration/cam_to_cam.yaml");
  EXPECT_THAT(error_of([&] { return open_public_sequence(folder.path()).has_value(); }),
              HasSubstr("cam_to_cam.yaml"));
}

std::string basalt_pose(const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond& q = pose.rotation();
  return fmt::format(R"({{"px": {}, "py": {}, "pz": {}, "qx": {}, "qy": {}, "qz": {}, "qw": {}}})",
                     t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

Rigid3 turned(double angle, const Eigen::Vector3d& t) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), t};
}

const Rigid3 kImuFromCamera = turned(0.4, {0.05, -0.02, 0.01});
const Rigid3 kImuFromMarker = turned(-0.7, {0.1, 0.03, -0.04});

Rigid3 true_camera(double t_s) { return turned(0.3 * t_s, {t_s, 0.5 * t_s, 1}); }

void write_tum_vie(const TemporaryFolder& folder) {
  write_h5(folder.path() / "mocap-desk-events_left.h5", some_events(0.5, 1500, 320, 180));
  std::string poses, models, sizes;
  for (int i = 0; i < 4; ++i) {
    const char* comma = i == 0 ? "" : ", ";
    poses += comma + basalt_pose(i == 2 ? kImuFromCamera : Rigid3());
    models += comma + std::string(R"({"camera_type": "kb4", "intrinsics": {"fx": 260, "fy": 261,
      "cx": 158, "cy": 88, "k1": 0.02, "k2": -0.01, "k3": 0.03, "k4": -0.02}})");
    sizes += comma + std::string("[320, 180]");
  }
  folder.write("camera-calibrationA.json",
               R"({"value0": {"T_imu_cam": [)" + poses + R"(], "intrinsics": [)" + models +
                   R"(], "resolution": [)" + sizes + R"(], "vignette": []}})");
  folder.write("mocap-imu-calibrationA.json",
               R"({"value0": {"T_imu_marker": )" + basalt_pose(kImuFromMarker) + "}}");
  std::string imu = "#timestamp[us] gx gy gz ax ay az temperature\n";
  std::string mocap = "#timestamp[us] tx ty tz qx qy qz qw\n";
  for (int i = 0; i < 260; ++i)
    imu += fmt::format("{}.25 0.1 0.2 0.3 1 2 9.8 30\n", 400000 + 5000 * i);
  for (int i = 0; i < 200; ++i) {
    const double t_s = 0.4 + 0.009 * i;
    const Rigid3 marker = true_camera(t_s) * kImuFromCamera.inverse() * kImuFromMarker;
    const Eigen::Vector3d& t = marker.translation();
    const Eigen::Quaterniond& q = marker.rotation();
    mocap += fmt::format("{:.1f} {} {} {} {} {} {} {}\n", 1e6 * t_s, t.x(), t.y(), t.z(), q.x(),
                         q.y(), q.z(), q.w());
  }
  folder.write("mocap-desk-vi_gt_data/imu_data.txt", imu);
  folder.write("mocap-desk-vi_gt_data/mocap_data.txt", mocap);
}

TEST(TumVie, BecomesADatasetWithThePosesOfTheEventCamera) {
  const TemporaryFolder folder;
  write_tum_vie(folder);
  const auto sequence = open_public_sequence(folder.path());
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->layout, "TUM-VIE");
  EXPECT_LT(sequence->camera.residual_px, 0.1);
  const TemporaryFolder out;
  EXPECT_EQ(write_as_dataset(*sequence, out.path() / "data").events, 1500U);
  const Dataset dataset = Dataset::open(out.path() / "data");
  EXPECT_EQ(dataset.load_events(), some_events(0.5, 1500, 320, 180));
  for (const StampedPose& pose : dataset.groundtruth().poses())
    EXPECT_LT((pose.world_from_camera.inverse() * true_camera(pose.t_s)).log().norm(), 1e-6);
  const auto imu = dataset.load_imu();
  ASSERT_FALSE(imu.empty());
  EXPECT_EQ(imu[0].specific_force, Eigen::Vector3d(1, 2, 9.8));
  EXPECT_EQ(imu[0].angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
  const auto chain = read_camera_chain(out.path() / "data/camera.yaml");
  EXPECT_LT((*chain[0].camera_from_imu * kImuFromCamera).log().norm(), 1e-9);
}

TEST(TumVie, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  write_tum_vie(folder);
  const auto error = [&] {
    return error_of([&] { return open_public_sequence(folder.path()).has_value(); });
  };
  folder.write("camera-calibrationB.json", "{}");
  EXPECT_THAT(error(), HasSubstr("keep the one"));
  fs::remove(folder.path() / "camera-calibrationB.json");
  fs::remove(folder.path() / "mocap-imu-calibrationA.json");
  EXPECT_THAT(error(), HasSubstr("mocap-imu-calibration"));
  fs::remove(folder.path() / "camera-calibrationA.json");
  EXPECT_THAT(error(), HasSubstr("camera-calibration*.json"));
}

TEST(PublicSequence, OtherFoldersAreNone) {
  const TemporaryFolder folder;
  EXPECT_FALSE(open_public_sequence(folder.path()));
}

}  // namespace
}  // namespace saccade
