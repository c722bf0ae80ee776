// Sequences of M3ED, MVSEC, VECtor and EDS, which are written here in their publishers' layouts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/fisheye_camera.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/events_h5.h"
#include "core/io/import/public_sequence.h"
#include "core/process/progress.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/h5_content.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using testing::H5Content;
using ::testing::HasSubstr;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr int kEvents = 500;

Rigid3 turned_by(double angle, const Eigen::Vector3d& t) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized())), t};
}

/// world_from_camera of the event camera.
Rigid3 camera_at(double t_s) { return turned_by(0.3 * t_s, {t_s, 0.5 * t_s, 1}); }

const Rigid3 kCameraFromImu = turned_by(0.5, {0.01, -0.02, 0.03});

std::vector<double> rows_of(const Rigid3& pose) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation_matrix();
  matrix.topRightCorner<3, 1>() = pose.translation();
  return {matrix.data(), matrix.data() + 16};
}

std::string yaml_of(const Rigid3& pose) {
  const std::vector<double> m = rows_of(pose);
  std::string text = "[";
  for (std::size_t r = 0; r < 4; ++r)
    text += fmt::format("{}[{}, {}, {}, {}]", r == 0 ? "" : ", ", m[4 * r], m[4 * r + 1],
                        m[4 * r + 2], m[4 * r + 3]);
  return text + "]";
}

std::string flat_yaml_of(const Rigid3& pose) {
  std::string text;
  for (const double value : rows_of(pose))
    text += (text.empty() ? "[" : ", ") + fmt::to_string(value);
  return text + "]";
}

/// An event each millisecond from `start_us` on.
struct Recorded {
  Events events;
  std::vector<std::uint16_t> x, y;
  std::vector<std::uint8_t> p;
  std::vector<std::int64_t> t;
  std::vector<double> rows;  ///< x y t[s] p

  explicit Recorded(std::int64_t start_us) {
    for (int i = 0; i < kEvents; ++i) {
      const auto column = static_cast<std::uint16_t>(i % kWidth);
      const auto row = static_cast<std::uint16_t>(i % kHeight);
      const std::int64_t t_us = start_us + 1000 * i;
      const auto on = static_cast<std::uint8_t>(i % 2);
      events.push_back({t_us * 1000, column, row, static_cast<std::int8_t>(on == 1 ? 1 : -1)});
      x.push_back(column);
      y.push_back(row);
      p.push_back(on);
      t.push_back(t_us);
      for (const double value : {static_cast<double>(column), static_cast<double>(row),
                                 1e-6 * static_cast<double>(t_us), on == 1 ? 1.0 : -1.0})
        rows.push_back(value);
    }
  }
};

std::string tum_line(double t_s, const Rigid3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond& q = pose.rotation();
  return fmt::format("{:.6f} {} {} {} {} {} {} {}\n", t_s, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(),
                     q.w());
}

class H5Sequences : public ::testing::Test {
 protected:
  H5Sequences() { set_progress_quiet(true); }

  /// Imports the folder, and compares events and poses.
  Dataset imported(const std::string& layout, const Events& events,
                   const fs::path& calibration = {}) {
    const auto sequence = open_public_sequence(root(), calibration);
    EXPECT_TRUE(sequence);
    if (!sequence) throw InputError("", "is no sequence");
    EXPECT_EQ(sequence->layout, layout);
    const fs::path out = folder_.path() / "out";
    fs::remove_all(out);
    static_cast<void>(write_as_dataset(*sequence, out));
    Dataset dataset = Dataset::open(out);
    EXPECT_EQ(dataset.load_events(), events);
    return dataset;
  }
  static void expect_poses(const Dataset& dataset, const Rigid3& world_from_here = {}) {
    EXPECT_GT(dataset.groundtruth().size(), 20U);
    for (const StampedPose& pose : dataset.groundtruth().poses()) {
      const Rigid3 world_from_camera = world_from_here * pose.world_from_camera;
      EXPECT_LT((world_from_camera.inverse() * camera_at(pose.t_s)).log().norm(), 1e-5) << pose.t_s;
    }
  }
  [[nodiscard]] fs::path root() const { return folder_.path() / "sequences" / "some_sequence"; }
  [[nodiscard]] std::string at(const std::string& name) const {
    return "sequences/some_sequence/" + name;
  }

  testing::TemporaryFolder folder_;
};

/// M3ED's world is the camera at the first pose, and its matrices are those of the world in the camera.
TEST_F(H5Sequences, M3ed) {
  const Recorded recorded(2'000'000);
  const std::string left = "/prophesee/left";
  const Rigid3 start = camera_at(1.9);
  std::vector<double> imu_rows, rates, poses;
  std::vector<std::int64_t> imu_times, pose_times;
  for (int i = 0; i < 60; ++i) {
    imu_times.push_back(1'900'000 + 10'000 * i);
    imu_rows.insert(imu_rows.end(), {1, 2, 9.8});
    rates.insert(rates.end(), {0.1, 0.2, 0.3});
    pose_times.push_back(1'900'000 + 20'000 * i);
    const Rigid3 now = camera_at(1e-6 * static_cast<double>(pose_times.back()));
    const std::vector<double> rows = rows_of((start.inverse() * now).inverse());
    poses.insert(poses.end(), rows.begin(), rows.end());
  }
  H5Content(root() / "some_sequence_data.h5")
      .column(left + "/x", recorded.x)
      .column(left + "/y", recorded.y)
      .column(left + "/p", recorded.p)
      .column(left + "/t", recorded.t)
      .text(left + "/calib/camera_model", "pinhole")
      .text(left + "/calib/distortion_model", "radtan")
      .column(left + "/calib/intrinsics", std::vector<double>{100, 101, 31.5, 23.5})
      .column(left + "/calib/distortion_coeffs", std::vector<double>{-0.1, 0.02, 0, 0})
      .column(left + "/calib/resolution", std::vector<std::int64_t>{kWidth, kHeight})
      .column("/ovc/imu/ts", imu_times)
      .array<double>("/ovc/imu/accel", {60, 3}, imu_rows)
      .array<double>("/ovc/imu/omega", {60, 3}, rates)
      .array<double>("/ovc/imu/calib/T_to_prophesee_left", {4, 4}, rows_of(kCameraFromImu));
  H5Content(root() / "some_sequence_pose_gt.h5")
      .array<double>("/Cn_T_C0", {60, 4, 4}, poses)
      .column("/ts", pose_times);
  std::vector<float> depth(2 * kWidth * kHeight, 3.5F);
  depth[0] = std::numeric_limits<float>::infinity();
  H5Content(root() / "some_sequence_depth_gt.h5")
      .array<float>("/depth/prophesee/left", {2, kHeight, kWidth}, depth)
      .column("/ts", std::vector<std::int64_t>{2'100'000, 2'200'000});
  const Dataset dataset = imported("M3ED", recorded.events);
  expect_poses(dataset, start);
  EXPECT_EQ(dataset.camera().distortion[1], 0.02);
  ASSERT_EQ(dataset.depth_maps().size(), 2U);
  EXPECT_NEAR(dataset.depth_maps()[1].t_s, 2.2, 1e-9);
  EXPECT_EQ(dataset.load_depth(0)(0, 0), 0);
  EXPECT_EQ(dataset.load_depth(0)(1, 0), 3.5F);
  const auto imu = dataset.load_imu();
  ASSERT_EQ(imu.size(), 60U);
  EXPECT_EQ(imu[0].specific_force, Eigen::Vector3d(1, 2, 9.8));
  EXPECT_EQ(imu[0].angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
  const auto chain = read_camera_chain(folder_.path() / "out/camera.yaml");
  EXPECT_LT((chain[0].camera_from_imu->inverse() * kCameraFromImu).log().norm(), 1e-9);
}

/// MVSEC's chain of cameras has a lens of another model, and a clock of the inertial sensor.
TEST_F(H5Sequences, Mvsec) {
  const Recorded recorded(1'504'645'177'000'000);
  const double start_s = 1e-6 * static_cast<double>(recorded.t.front());
  const std::string left = "/davis/left/";
  std::vector<double> times, imu, poses;
  for (int i = 0; i < 60; ++i) {
    times.push_back(start_s + 0.01 * i);
    imu.insert(imu.end(), {1, 2, 9.8, 0.1, 0.2, 0.3});
    const std::vector<double> rows = rows_of(camera_at(times.back()));
    poses.insert(poses.end(), rows.begin(), rows.end());
  }
  std::vector<std::uint8_t> images(2 * kWidth * kHeight, 77);
  H5Content(root() / "some_sequence_data.hdf5")
      .array<double>(left + "events", {kEvents, 4}, recorded.rows)
      .array<std::uint8_t>(left + "image_raw", {2, kHeight, kWidth}, images)
      .column(left + "image_raw_ts", std::vector<double>{start_s + 0.1, start_s + 0.2})
      .array<double>(left + "imu", {60, 6}, imu)
      .column(left + "imu_ts", times);
  std::vector<float> depth(2 * kWidth * kHeight, 3.5F);
  depth[0] = std::numeric_limits<float>::quiet_NaN();
  H5Content(root() / "some_sequence_gt.hdf5")
      .array<double>(left + "pose", {60, 4, 4}, poses)
      .column(left + "pose_ts", times)
      .array<float>(left + "depth_image_raw", {2, kHeight, kWidth}, depth)
      .column(left + "depth_image_raw_ts", std::vector<double>{start_s + 0.1, start_s + 0.2});
  EXPECT_THAT(error_of([&] { return open_public_sequence(root()); }), HasSubstr("camchain*.yaml"));
  folder_.write("sequences/some_calib/camchain-imucam-some.yaml",
                "cam0:\n  T_cam_imu: " + yaml_of(kCameraFromImu) +
                    "\n  camera_model: pinhole\n  intrinsics: [60, 61, 31.5, 23.5]\n"
                    "  distortion_model: equidistant\n"
                    "  distortion_coeffs: [-0.03, 0.01, -0.005, 0.001]\n"
                    "  resolution: [64, 48]\n  timeshift_cam_imu: 0.05\n");
  const Dataset dataset = imported("MVSEC", recorded.events);
  expect_poses(dataset);
  const FisheyeCamera lens{kWidth, kHeight, 60, 61, 31.5, 23.5, {-0.03, 0.01, -0.005, 0.001}};
  const Eigen::Vector2d ray(0.3, -0.2);
  const PinholeCamera& camera = dataset.camera();
  EXPECT_LT((camera.distort(camera.project({ray.x(), ray.y(), 1})) - lens.project(ray)).norm(),
            0.1);
  ASSERT_EQ(dataset.frames().size(), 2U);
  ASSERT_EQ(dataset.depth_maps().size(), 2U);
  EXPECT_EQ(dataset.load_depth(0)(0, 0), 0);
  EXPECT_EQ(dataset.load_depth(1)(5, 5), 3.5F);
  // The inertial sensor's clock is 50 ms ahead of the camera's.
  EXPECT_NEAR(seconds_from_ns(dataset.load_imu()[0].t_ns), start_s - 0.05, 1e-6);
  EXPECT_EQ(dataset.load_imu()[0].specific_force, Eigen::Vector3d(1, 2, 9.8));
}

/// VECtor's poses are those of the body that the motion capture saw.
TEST_F(H5Sequences, Vector) {
  const Recorded recorded(7'000'000);
  const fs::path events = root() / "some_sequence1.synced.left_event.hdf5";
  fs::create_directories(root());
  EventH5Writer writer(events, TimestampUnit::kMicroseconds);
  writer.append(recorded.events);
  writer.close();
  const Rigid3 regular_from_body = turned_by(0.8, {0.1, 0.2, 0.3});
  const Rigid3 regular_from_events = turned_by(-0.2, {0.05, 0, 0});
  std::string poses = "# some\n# header\n";
  for (int i = 0; i < 60; ++i) {
    const double t_s = 6.9 + 0.01 * i;
    poses += tum_line(t_s, camera_at(t_s) * regular_from_events.inverse() * regular_from_body);
  }
  folder_.write(at("some_sequence1.synced.gt.txt"), poses);
  EXPECT_THAT(error_of([&] { return open_public_sequence(root()); }),
              HasSubstr("left_event_camera_intrinsic_results"));
  folder_.write("sequences/0_calib/left_event_camera_intrinsic_results.yaml",
                "image_width: 64\nimage_height: 48\ncamera_name: left\n"
                "camera_matrix: {rows: 3, cols: 3, data: [100, 0, 31.5, 0, 101, 23.5, 0, 0, 1]}\n"
                "distortion_model: plumb_bob\n"
                "distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.02, 0, 0, 0.001]}\n");
  folder_.write("sequences/0_calib/small_scale_joint_camera_extrinsic_results.yaml",
                "cam2:\n  T_cam0_cam2: " + yaml_of(regular_from_events) + "\n");
  folder_.write("sequences/0_calib/camera_mocap_extrinsic_results1.yaml",
                "cam0:\n  T_cam_body: " + flat_yaml_of(regular_from_body) + "\n");
  const Dataset dataset = imported("VECtor", recorded.events);
  expect_poses(dataset);
  EXPECT_EQ(dataset.camera().distortion[4], 0.001);
}

TEST_F(H5Sequences, Eds) {
  const Recorded recorded(1'635'000'000'000'000);
  const double start_s = 1e-6 * static_cast<double>(recorded.t.front());
  H5Content(root() / "events.h5")
      .column("/x", recorded.x)
      .column("/y", recorded.y)
      .column("/p", recorded.p)
      .column("/t", recorded.t);
  std::string poses = "# timestamp[s] px py pz qx qy qz qw\n";
  for (int i = 0; i < 60; ++i) {
    const double t_s = std::round(1e6 * (start_s - 0.05 + 0.01 * i)) / 1e6;
    poses += tum_line(t_s, camera_at(t_s));
  }
  folder_.write(at("stamped_groundtruth.txt"), poses);
  EXPECT_THAT(error_of([&] { return open_public_sequence(root()); }), HasSubstr("--calibration"));
  folder_.write("sequences/00_calib/camchain.yaml",
                "cam0: {camera_model: pinhole, intrinsics: [80, 80, 30, 20], distortion_model: "
                "radtan, distortion_coeffs: [0, 0, 0, 0], resolution: [60, 40]}\n"
                "cam1: {camera_model: pinhole, intrinsics: [100, 101, 31.5, 23.5], "
                "distortion_model: radtan, distortion_coeffs: [-0.1, 0.02, 0, 0], resolution: [64, "
                "48]}\n");
  const Dataset dataset = imported("EDS", recorded.events);
  expect_poses(dataset);
  EXPECT_EQ(dataset.camera().fx, 100);
}

TEST_F(H5Sequences, MatricesThatAreNoPosesAreNamed) {
  const Recorded recorded(2'000'000);
  const std::string left = "/davis/left/";
  H5Content(root() / "s_data.hdf5").array<double>(left + "events", {kEvents, 4}, recorded.rows);
  std::vector<double> matrix(16, 0.5);
  H5Content(root() / "s_gt.hdf5")
      .array<double>(left + "pose", {1, 4, 4}, matrix)
      .column(left + "pose_ts", std::vector<double>{2.0});
  folder_.write(at("camchain.yaml"),
                "cam0: {camera_model: pinhole, intrinsics: [100, 101, 31.5, 23.5], "
                "distortion_model: none, resolution: [64, 48]}\n");
  EXPECT_THAT(error_of([&] { return open_public_sequence(root()); }),
              HasSubstr("s_gt.hdf5:/davis/left/pose[0]: is no rigid transformation"));
}

}  // namespace
}  // namespace saccade
