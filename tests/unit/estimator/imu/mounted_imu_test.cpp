#include "estimator/imu/imu_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/dataset/dataset_writer.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kReadings = "0.000 0 0 9.81 0.1 0.2 0.3\n0.001 0 0 9.81 0.1 0.2 0.3\n";
/// The sensor's x axis is the camera's z axis, its y axis the camera's x axis.
constexpr const char* kChain =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [20, 20, 15.5, 11.5]\n  resolution: [32, 24]\n"
    "  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n"
    "  T_cam_imu: [[0, 1, 0, 0.01], [0, 0, 1, 0.02], [1, 0, 0, 0.03], [0, 0, 0, 1]]\n";

/// A dataset without pictures, to which tests add what is said of its inertial sensor.
class Mounted : public ::testing::Test {
 protected:
  void SetUp() override {
    DatasetWriter writer(data(), PinholeCamera{32, 24, 20, 20, 15.5, 11.5, {}}, {});
    writer.write_events({});
    writer.finish({});
  }
  [[nodiscard]] fs::path data() const { return folder_.path() / "data"; }
  void write(const std::string& name, const std::string& text) const {
    folder_.write("data/" + name, text);
  }
  [[nodiscard]] MountedImu load() const {
    return load_mounted_imu(Dataset::open(data()), "the test");
  }
  [[nodiscard]] std::string error() const {
    return testing::error_of([&] { return load().samples.size(); });
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Mounted, TurnsTheReadingsIntoTheCamerasAxes) {
  write("imu.txt", kReadings);
  write("camera.yaml", kChain);
  const MountedImu imu = load();
  ASSERT_EQ(imu.samples.size(), 2U);
  EXPECT_LT((imu.samples[1].specific_force - Eigen::Vector3d(0, 9.81, 0)).norm(), 1e-12);
  EXPECT_LT((imu.samples[1].angular_velocity - Eigen::Vector3d(0.2, 0.3, 0.1)).norm(), 1e-12);
  EXPECT_LT((imu.position_in_camera - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-12);
}

TEST_F(Mounted, NoiseThatNobodyStatesIsThatOfAConsumersSensor) {
  write("imu.txt", kReadings);
  EXPECT_EQ(load().noise.gyroscope.density, 1e-3);
  write("imu.yaml",
        "accelerometer_noise_density: 0.002\naccelerometer_random_walk: 0\n"
        "gyroscope_noise_density: 0\ngyroscope_random_walk: 0\nupdate_rate: 1000\n");
  EXPECT_EQ(load().noise.accelerometer.density, 0.002);
  EXPECT_EQ(load().noise.gyroscope.density, 1e-3);
}

TEST_F(Mounted, WithoutReadingsNamesTheDatasetAndWhoNeedsThem) {
  EXPECT_THAT(error(), AllOf(StartsWith(data().string()), HasSubstr("the test")));
  write("imu.txt", "");
  EXPECT_THAT(error(), AllOf(StartsWith(data().string()), HasSubstr("without readings")));
}

TEST_F(Mounted, MalformedFilesAreRefusedWithTheirPlace) {
  const auto at = [&](const std::string& name) { return StartsWith((data() / name).string()); };
  for (const char* line :
       {"0.002 0 0 9.81 0 0", "0.002 0 0 nan 0 0 0", "0.001 0 0 9.81 0 0 0",
        "0.0005 0 0 9.81 0 0 0", "0.002 0 0 9.81 0 0 0 7", "soon 0 0 9.81 0 0 0"}) {
    write("imu.txt", kReadings + std::string(line) + "\n");
    EXPECT_THAT(error(), at("imu.txt:3")) << line;
  }
  write("imu.txt", kReadings);
  write("imu.yaml", "update_rate: often\n");
  EXPECT_THAT(error(), at("imu.yaml:1"));
  fs::remove(data() / "imu.yaml");
  for (const char* transform : {"[[1, 0, 0, 0], [0, 1, 0, 0]]",
                                "[[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"}) {
    std::string chain(kChain);
    chain.replace(chain.find("[[0, 1"), std::string::npos, std::string(transform) + "\n");
    write("camera.yaml", chain);
    EXPECT_THAT(error(), at("camera.yaml")) << transform;
  }
}

}  // namespace
}  // namespace saccade
