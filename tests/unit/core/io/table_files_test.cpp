#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/io/calibration_file.h"
#include "core/io/files/file_list.h"
#include "core/io/imu_file.h"
#include "core/io/tables/csv_file.h"
#include "core/io/trajectory_file.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;
using ::testing::StartsWith;
using testing::TemporaryFolder;

class TableFiles : public ::testing::Test {
 protected:
  std::string calib_error(const std::string& text) {
    return error_of([&] { return read_calib_txt(folder_.write("calib.txt", text)); });
  }
  std::string camera_error(const std::string& text) {
    return error_of([&] { return read_camera_yaml(folder_.write("camera.yaml", text)); });
  }
  std::string list_error(const std::string& text) {
    return error_of([&] { return read_file_list(folder_.write("images.txt", text)); });
  }
  std::string imu_error(const std::string& text) {
    return error_of([&] { return read_imu(folder_.write("imu.txt", text)); });
  }

  TemporaryFolder folder_;
};

TEST_F(TableFiles, CalibRoundTrip) {
  const PinholeCamera camera{
      0, 0, 335.419462958, 335.35, 129.9, 99.1, {-0.1, 0.09, -3e-4, 1e-4, 0.5}};
  write_calib_txt(folder_.path() / "calib.txt", camera);
  EXPECT_EQ(read_calib_txt(folder_.path() / "calib.txt"), camera);
}

TEST_F(TableFiles, CalibWithoutDistortion) {
  const PinholeCamera camera = read_calib_txt(folder_.write("calib.txt", "200 201 120 90\n"));
  EXPECT_EQ(camera.fy, 201);
  EXPECT_FALSE(camera.is_distorted());
}

TEST_F(TableFiles, CalibErrors) {
  EXPECT_THAT(calib_error("200 200 120\n"), HasSubstr("calib.txt:1: cy: expected a number"));
  EXPECT_THAT(calib_error("200 200 120 90 0.1\n"), HasSubstr("calib.txt:1: k2: expected"));
  EXPECT_THAT(calib_error("1 2 3 4 5 6 7 8 9 10\n"), HasSubstr("calib.txt:1: more fields"));
  EXPECT_THAT(calib_error("1 2 3 4\n1 2 3 4\n"), HasSubstr("calib.txt:2: only one line"));
  EXPECT_THAT(calib_error("1 2 3 nan\n"), HasSubstr("cy: expected a finite number"));
  EXPECT_THAT(calib_error(""), HasSubstr("calib.txt: is empty"));
}

TEST_F(TableFiles, CameraYamlRoundTrip) {
  PinholeCamera camera{240, 180, 335.419462958, 335.35, 129.9, 99.1, {-0.1, 0.09, -3e-4, 1e-4, 0}};
  for (const double k3 : {0.0, 0.25}) {
    camera.distortion[4] = k3;
    write_camera_yaml(folder_.path() / "camera.yaml", camera);
    EXPECT_EQ(read_camera_yaml(folder_.path() / "camera.yaml"), camera);
  }
}

TEST_F(TableFiles, CameraYamlOfKalibrItself) {
  const PinholeCamera camera = read_camera_yaml(folder_.write("camera.yaml", R"(cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.7e-05]
  distortion_model: radtan
  intrinsics: [458.6, 457.3, 367.2, 248.4]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
)"));
  EXPECT_EQ(camera.width, 752);
  EXPECT_EQ(camera.distortion[3], 1.7e-05);
}

TEST_F(TableFiles, CameraYamlErrors) {
  const std::string rest = "  intrinsics: [1, 1, 1, 1]\n  distortion_model: none\n";
  EXPECT_THAT(camera_error("cam1: {}\n"), HasSubstr("key 'cam0' is missing"));
  EXPECT_THAT(camera_error("cam0:\n  camera_model: omni\n"),
              HasSubstr("camera.yaml:2: camera_model: 'omni' is not supported"));
  EXPECT_THAT(camera_error("cam0:\n  camera_model: pinhole\n" + rest),
              HasSubstr("key 'resolution' is missing"));
  EXPECT_THAT(camera_error("cam0:\n  camera_model: pinhole\n  resolution: [0, 5]\n" + rest),
              HasSubstr("camera has no area"));
  EXPECT_THAT(camera_error("cam0:\n  camera_model: pinhole\n  resolution: [4]\n" + rest),
              HasSubstr("camera.yaml:3"));
}

TEST_F(TableFiles, FileListRoundTripIsRelative) {
  const std::filesystem::path root = folder_.path();
  const std::vector<StampedFile> files{{0, root / "images/a.png"}, {0.038766001, root / "b.png"}};
  write_file_list(root / "images.txt", files);
  EXPECT_EQ(read_file(root / "images.txt"), "0.000000000 images/a.png\n0.038766001 b.png\n");
  const std::vector<StampedFile> read = read_file_list(root / "images.txt");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].file, files[0].file);
  EXPECT_EQ(read[1].t_s, 0.038766001);
}

TEST_F(TableFiles, FileListErrors) {
  EXPECT_THAT(list_error("0 a.png\n0 b.png\n"), HasSubstr("images.txt:2: times must increase"));
  EXPECT_THAT(list_error("0\n"), HasSubstr("images.txt:1: file: expected a word"));
  EXPECT_THAT(list_error("a.png 0\n"), HasSubstr("images.txt:1: t: expected a number"));
  EXPECT_THAT(list_error("0 a.png b\n"), HasSubstr("images.txt:1: more fields"));
}

TEST_F(TableFiles, ImuRoundTripIsExact) {
  const std::vector<ImuSample> samples{{-1, {0.1, 0.2, 9.81}, {1e-9, -2, 3}},
                                       {1'468'939'993'123'456'789, {1.0 / 3, 0, 0}, {0, 0, 0}}};
  write_imu(folder_.path() / "imu.txt", samples);
  const std::vector<ImuSample> read = read_imu(folder_.path() / "imu.txt");
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].t_ns, samples[i].t_ns);
    EXPECT_EQ(read[i].specific_force, samples[i].specific_force);
    EXPECT_EQ(read[i].angular_velocity, samples[i].angular_velocity);
  }
}

TEST_F(TableFiles, ImuErrors) {
  EXPECT_THAT(imu_error("0 1 2 3 4 5\n"), HasSubstr("imu.txt:1: gz: expected a number"));
  EXPECT_THAT(imu_error("1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n"), HasSubstr("imu.txt:2: times must"));
  EXPECT_THAT(imu_error("1 0 inf 0 0 0 0\n"), HasSubstr("ay: expected a finite"));
}

TEST_F(TableFiles, ImuTruthRoundTripIsExactAndNamesItsColumns) {
  const std::filesystem::path file = folder_.path() / "imu_groundtruth.txt";
  const std::vector<ImuTruth> truth{
      {{0, {0.1, 0.2, 9.81}, {1e-9, -2, 3}}, {1.0 / 3, 0, 0}, {0, 2.0 / 3, 0}},
      {{1'000'000, {0, 0, 0}, {0, 0, 0}}, {1, 2, 3}, {4, 5, 6}}};
  write_imu_truth(file, truth);
  EXPECT_THAT(read_file(file), StartsWith("# t ax ay az gx gy gz bax bay baz bgx bgy bgz\n"));
  const std::vector<ImuTruth> read = read_imu_truth(file);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].ideal.specific_force, truth[i].ideal.specific_force);
    EXPECT_EQ(read[i].ideal.angular_velocity, truth[i].ideal.angular_velocity);
    EXPECT_EQ(read[i].accel_bias, truth[i].accel_bias);
    EXPECT_EQ(read[i].gyro_bias, truth[i].gyro_bias);
  }
}

TEST_F(TableFiles, GyroBiasRoundTripIsExactAndNamesWhatIsWrong) {
  const std::filesystem::path file = folder_.path() / "gyro_bias.txt";
  const std::vector<GyroBiasEstimate> biases{{0, {0.1, -1e-9, 3}, 0.01, true},
                                             {1'000'000, {0.3, 0, 0}, 0.005, false}};
  write_gyro_biases(file, biases);
  const std::vector<GyroBiasEstimate> read = read_gyro_biases(file);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].t_ns, biases[i].t_ns);
    EXPECT_EQ(read[i].bias, biases[i].bias);
    EXPECT_EQ(read[i].sigma, biases[i].sigma);
    EXPECT_EQ(read[i].at_rest, biases[i].at_rest);
  }
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_gyro_biases(folder_.write("gyro_bias.txt", text)); });
  };
  EXPECT_THAT(error("0 1 2 3 4 2\n"), HasSubstr("gyro_bias.txt:1: at_rest must be 0 or 1"));
  EXPECT_THAT(error("1 0 0 0 0 0\n1 0 0 0 0 0\n"), HasSubstr("gyro_bias.txt:2: times must"));
}

TEST_F(TableFiles, ImuYamlIsKalibrs) {
  const std::filesystem::path file = folder_.path() / "imu.yaml";
  write_imu_yaml(file, {200, {0.01, 2e-4}, {1.7e-3, 2e-5}});
  const ImuCalibration imu = read_imu_yaml(file);
  EXPECT_EQ(imu.rate_hz, 200);
  EXPECT_EQ(imu.accelerometer.density, 0.01);
  EXPECT_EQ(imu.gyroscope.random_walk, 2e-5);
  EXPECT_EQ(read_imu_yaml(folder_.write("kalibr.yaml", R"(#Accelerometers
accelerometer_noise_density: 1.86e-03   #Noise density (continuous-time)
accelerometer_random_walk:   4.33e-04   #Bias random walk
gyroscope_noise_density:     1.87e-04
gyroscope_random_walk:       2.66e-05
rostopic:                    /imu0      #the IMU ROS topic
update_rate:                 200.0      #Hz
)"))
                .accelerometer.random_walk,
            4.33e-4);
  EXPECT_THAT(
      error_of([&] { return read_imu_yaml(folder_.write("imu.yaml", "update_rate: 1\n")); }),
      HasSubstr("accelerometer_noise_density"));
}

TEST_F(TableFiles, TwistsRoundTrip) {
  const std::filesystem::path file = folder_.path() / "twist.txt";
  write_twists(file, std::vector<StampedTwist>{{0, {0.1, 1.0 / 3, -2}, {1e-9, 0, 3}},
                                               {0.001, {1, 2, 3}, {4, 5, 6}}});
  EXPECT_EQ(read_file(file),
            "# t vx vy vz wx wy wz\n0.000000000 0.1 0.3333333333333333 -2 1e-09 0 3\n"
            "0.001000000 1 2 3 4 5 6\n");
  const std::vector<StampedTwist> read = read_twists(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].velocity, Eigen::Vector3d(0.1, 1.0 / 3, -2));
  EXPECT_EQ(read[1].angular_velocity, Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(error_of([&] {
                return read_twists(folder_.write("t.txt", "0 1 2 3 4 5 6\n0 1 2 3 4 5 6\n"));
              }),
              HasSubstr("t.txt:2: times must increase"));
}

TEST_F(TableFiles, CameraChainRoundTrip) {
  const std::filesystem::path file = folder_.path() / "camera.yaml";
  const Rigid3 imu(so3_exp({0.1, 0.2, 0.3}), {1, 2, 3});
  const Rigid3 base(so3_exp({0, 0.01, 0}), {-0.1, 0, 0});
  const PinholeCamera left{240, 180, 335.4, 335.3, 129.9, 99.1, {-0.1, 0.09, -3e-4, 1e-4, 0}};
  const PinholeCamera right{346, 260, 250, 251, 172, 129, {}};
  write_camera_chain(file, std::vector<ChainCamera>{{left, imu, {}}, {right, base * imu, base}});
  EXPECT_EQ(read_camera_yaml(file), left);
  const std::vector<ChainCamera> read = read_camera_chain(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1].camera, right);
  EXPECT_FALSE(read[0].camera_from_previous.has_value());
  EXPECT_LT((read[1].camera_from_previous->inverse() * base).log().norm(), 1e-14);
  EXPECT_LT((read[0].camera_from_imu->inverse() * imu).log().norm(), 1e-14);
  EXPECT_THAT(read_file(file), AllOf(HasSubstr("T_cn_cnm1:"), HasSubstr("T_cam_imu:"),
                                     HasSubstr("timeshift_cam_imu: 0")));
}

TEST_F(TableFiles, CsvQuotesAndLeavesNanEmpty) {
  CsvTable table({"name", "value", "count"});
  table.add({std::string("a,\"b\""), 0.1, 3LL});
  table.add({std::string("c"), std::numeric_limits<double>::quiet_NaN(), -1LL});
  table.save(folder_.path() / "t.csv");
  EXPECT_EQ(read_file(folder_.path() / "t.csv"),
            "name,value,count\n\"a,\"\"b\"\"\",0.1,3\nc,,-1\n");
}

}  // namespace
}  // namespace saccade
