#include "core/io/import/ros_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/process/progress.h"
#include "core/srgb.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/ros/bag_bytes.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::bag_chunk;
using testing::bag_connection;
using testing::bag_message;
using testing::bytes_of;
using testing::error_of;
using testing::event_array;
using ::testing::HasSubstr;
using testing::kBagHead;
using testing::sized;

std::string stamp(std::uint32_t seconds, std::uint32_t ns) {
  return bytes_of(std::uint32_t{0}, seconds, ns) + sized("frame");
}

std::string numbers(std::initializer_list<double> values) {
  std::string bytes;
  for (const double value : values) bytes += bytes_of(value);
  return bytes;
}

std::string imu(std::uint32_t ns, double rate, double force) {
  return stamp(0, ns) + numbers({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}) +
         numbers({rate, 0, -rate, 0, 0, 0, 0, 0, 0, 0, 0, 0}) +
         numbers({0, 0, force, 0, 0, 0, 0, 0, 0, 0, 0, 0});
}

std::string pose(std::uint32_t ns, double x) {
  return stamp(0, ns) + numbers({x, 2, 3, 0.6, 0, 0, 0.8});
}

std::string camera_info(double fx, const std::string& model = "plumb_bob") {
  return stamp(0, 0) + bytes_of(std::uint32_t{180}, std::uint32_t{240}) + sized(model) +
         bytes_of(std::uint32_t{5}) + numbers({-0.3, 0.1, 0, 0, 0.01}) +
         numbers({fx, 0, 119.5, 0, 201, 89.5, 0, 0, 1});
}

/// Rows are padded by two bytes.
std::string picture(std::uint32_t ns, const std::string& encoding, std::uint32_t channels) {
  std::string data;
  for (std::uint32_t y = 0; y < 180; ++y) {
    for (std::uint32_t x = 0; x < 240 * channels; ++x)
      data += static_cast<char>(channels == 1 ? (x + y) % 256 : 40 * (x % 3));
    data += "--";
  }
  return stamp(0, ns) + bytes_of(std::uint32_t{180}, std::uint32_t{240}) + sized(encoding) +
         bytes_of(std::uint8_t{0}, 240 * channels + 2) + sized(data);
}

class RosBag : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path bag(const std::string& more) const {
    return folder_.write(
        "r.bag",
        kBagHead + bag_chunk("none", bag_connection(0, "/dvs/events", "dvs_msgs/EventArray") +
                                         bag_connection(1, "/dvs/imu", "sensor_msgs/Imu") +
                                         bag_connection(2, "/other/imu", "sensor_msgs/Imu") +
                                         bag_connection(3, "/pose", "geometry_msgs/PoseStamped") +
                                         bag_connection(4, "/dvs/image", "sensor_msgs/Image") +
                                         bag_connection(5, "/dvs/info", "sensor_msgs/CameraInfo") +
                                         bag_message(0, event_array(events_)) + more));
  }
  [[nodiscard]] std::string error(const std::string& more) const {
    return error_of([&] { return write_ros_recording(bag(more), folder_.path() / "d"); });
  }

  testing::TemporaryFolder folder_;
  Events events_ = testing::random_events(1000, 1'000'000);
};

TEST_F(RosBag, BecomesADataset) {
  const ImportCounts counts = write_ros_recording(
      bag(bag_message(2, imu(1'500'000, 9, 9)) + bag_message(1, imu(1'500'000, 0.5, 9.81)) +
          bag_message(1, imu(1'600'000, 0.25, 9.8)) + bag_message(3, pose(1'500'000, 1)) +
          bag_message(3, pose(1'600'000, 1.5)) + bag_message(4, picture(1'550'000, "mono8", 1)) +
          bag_message(4, picture(1'650'000, "bgr8", 3)) + bag_message(5, camera_info(200))),
      folder_.path() / "d");
  EXPECT_EQ(counts.events, 1000U);
  EXPECT_EQ(counts.frames, 2U);
  EXPECT_EQ(counts.imu_samples, 2U);
  EXPECT_EQ(counts.poses, 2U);
  const Dataset dataset = Dataset::open(folder_.path() / "d");
  Events expected = events_;
  sort_ties(expected);
  EXPECT_EQ(dataset.load_events(), expected);
  EXPECT_EQ(dataset.camera().fx, 200);
  EXPECT_EQ(dataset.camera().fy, 201);
  EXPECT_EQ(dataset.camera().distortion[4], 0.01);
  const std::vector<ImuSample> samples = dataset.load_imu();
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].t_ns, 1'500'000);
  EXPECT_NEAR(samples[0].angular_velocity.z(), -0.5, 1e-9);
  EXPECT_NEAR(samples[0].specific_force.z(), 9.81, 1e-9);
  ASSERT_EQ(dataset.groundtruth().size(), 2U);
  const StampedPose& second = dataset.groundtruth().poses()[1];
  EXPECT_NEAR(second.world_from_camera.translation().x(), 1.5, 1e-12);
  EXPECT_NEAR(second.world_from_camera.rotation().w(), 0.8, 1e-12);
  ASSERT_EQ(dataset.frames().size(), 2U);
  EXPECT_NEAR(dataset.frames()[0].t_s, 0.00155, 1e-9);
  EXPECT_NEAR(dataset.load_frame(0)(7, 5), linear_from_srgb8(std::uint8_t{12}), 1e-6);
  // 0.114 * 0 + 0.587 * 40 + 0.299 * 80 of blue, green and red.
  EXPECT_NEAR(dataset.load_frame(1)(7, 5), linear_from_srgb8(std::uint8_t{47}), 1e-6);
}

TEST_F(RosBag, TakesTheCameraFromAFileBesideIt) {
  EXPECT_THAT(error(""), HasSubstr("r.bag: holds no calibrated sensor_msgs/CameraInfo; name a"));
  folder_.write("calib.txt", "150 150 120 90 0 0 0 0 0\n");
  EXPECT_EQ(write_ros_recording(bag(""), folder_.path() / "d").events, 1000U);
  EXPECT_EQ(Dataset::open(folder_.path() / "d").camera().width, testing::kSensor.width);
}

/// A camera beside the event camera must not keep its events from being read.
TEST_F(RosBag, CamerasThatCannotBeReadAreLeftOut) {
  set_progress_quiet(true);
  const std::string info = bag_message(5, camera_info(200));
  const ImportCounts bayer = write_ros_recording(
      bag(info + bag_message(4, picture(1'500'000, "bayer_rggb8", 1))), folder_.path() / "d");
  EXPECT_EQ(bayer.events, 1000U);
  EXPECT_EQ(bayer.frames, 0U);
  const std::string other_camera = bag_connection(6, "/dvs/image2", "sensor_msgs/Image") +
                                   bag_connection(7, "/other/info", "sensor_msgs/CameraInfo") +
                                   bag_message(7, camera_info(200, "double_sphere"));
  std::string small = stamp(0, 1'500'000) + bytes_of(std::uint32_t{1}, std::uint32_t{2}) +
                      sized("mono8") + bytes_of(std::uint8_t{0}, std::uint32_t{2}) + sized("ab");
  const ImportCounts counts =
      write_ros_recording(bag(other_camera + info + bag_message(6, small) +
                              bag_message(4, picture(1'500'000, "mono8", 1))),
                          folder_.path() / "d");
  EXPECT_EQ(counts.frames, 1U);
  EXPECT_EQ(Dataset::open(folder_.path() / "d").camera().fx, 200);
}

TEST_F(RosBag, DepthAndOdometryBecomeDepthMapsAndPoses) {
  set_progress_quiet(true);
  std::string metres, millimetres;
  for (int i = 0; i < 240 * 180; ++i) {
    metres += bytes_of(i == 0 ? std::numeric_limits<float>::quiet_NaN() : 1.5F);
    millimetres += bytes_of(static_cast<std::uint16_t>(i == 0 ? 0 : 2500));
  }
  const auto depth = [&](std::uint32_t ns, const std::string& encoding, std::uint32_t row,
                         const std::string& data) {
    return stamp(0, ns) + bytes_of(std::uint32_t{180}, std::uint32_t{240}) + sized(encoding) +
           bytes_of(std::uint8_t{0}, row) + sized(data);
  };
  const std::string odometry = stamp(0, 1'500'000) + sized("base") +
                               numbers({4, 2, 3, 0.6, 0, 0, 0.8}) + std::string(8 * 36, '\0') +
                               std::string(8 * (6 + 36), '\0');
  const ImportCounts counts = write_ros_recording(
      bag(bag_message(5, camera_info(200)) + bag_connection(6, "/dvs/depth", "sensor_msgs/Image") +
          bag_connection(7, "/odometry", "nav_msgs/Odometry") +
          bag_message(6, depth(1'500'000, "32FC1", 960, metres)) +
          bag_message(6, depth(1'600'000, "16UC1", 480, millimetres)) + bag_message(7, odometry)),
      folder_.path() / "d");
  EXPECT_EQ(counts.depth_maps, 2U);
  EXPECT_EQ(counts.poses, 1U);
  const Dataset dataset = Dataset::open(folder_.path() / "d");
  EXPECT_EQ(dataset.load_depth(0)(0, 0), 0);
  EXPECT_EQ(dataset.load_depth(0)(5, 5), 1.5F);
  EXPECT_FLOAT_EQ(dataset.load_depth(1)(5, 5), 2.5F);
  EXPECT_EQ(dataset.groundtruth().poses()[0].world_from_camera.translation().x(), 4);
}

TEST_F(RosBag, NamesTheMessageOfWhatIsWrong) {
  const std::string info = bag_message(5, camera_info(200));
  EXPECT_THAT(error(info + bag_message(4, picture(1'500'000, "rgb8", 1))),
              HasSubstr("are no picture of 240 x 180 px"));
  EXPECT_THAT(error(info + bag_message(1, "short")), HasSubstr("/dvs/imu"));
  EXPECT_THAT(error(bag_message(5, camera_info(200, "equidistant"))),
              HasSubstr("the lens model 'equidistant' with 5 coefficients is not known"));
  EXPECT_FALSE(fs::exists(folder_.path() / "d"));
}

}  // namespace
}  // namespace saccade
