#include "core/io/ros/message_types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace saccade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// As rosmsg of ROS Noetic prints them.
TEST(MessageTypes, HaveTheMd5OfRos1) {
  EXPECT_EQ(ros1_md5("std_msgs/Header"), "2176decaecbce78abc3b96ef049fabed");
  EXPECT_EQ(ros1_md5("sensor_msgs/Image"), "060021388200f6f0f447d0fcd9c64743");
  EXPECT_EQ(ros1_md5("sensor_msgs/Imu"), "6a62c6daae103f4ff57a132d6f95cec2");
  EXPECT_EQ(ros1_md5("sensor_msgs/CameraInfo"), "c9a58c1b0b154e0e6da7578cb991d214");
  EXPECT_EQ(ros1_md5("sensor_msgs/PointCloud2"), "1158d486dd51d683ce2f1be655c3c181");
  EXPECT_EQ(ros1_md5("geometry_msgs/PoseStamped"), "d3812c3cbc69362b77dc0b19b345f8f5");
  EXPECT_EQ(ros1_md5("tf2_msgs/TFMessage"), "94810edda583a504dfda3829e70d7eec");
  EXPECT_EQ(ros1_md5("dvs_msgs/EventArray"), "5e8beee5a6c107e504c2e78903c224b8");
}

TEST(MessageTypes, DefinitionsOfRos2HoldTheTypesOfTheirFields) {
  const std::string text = ros2_definition("sensor_msgs/CameraInfo");
  EXPECT_THAT(text, HasSubstr("std_msgs/Header header\n"));
  EXPECT_THAT(text, HasSubstr("float64[9] k\n"));
  EXPECT_THAT(text, HasSubstr("\nMSG: builtin_interfaces/Time\nint32 sec\n"));
  EXPECT_THAT(text, HasSubstr("\nMSG: sensor_msgs/RegionOfInterest\n"));
  EXPECT_THAT(text, Not(HasSubstr("uint32 seq")));
  EXPECT_THAT(ros2_definition("sensor_msgs/PointCloud2"), HasSubstr("uint8 FLOAT32=7\n"));
  EXPECT_THAT(ros1_definition("dvs_msgs/EventArray"), HasSubstr("time ts\n"));
  EXPECT_EQ(ros2_type_name("sensor_msgs/Image"), "sensor_msgs/msg/Image");
}

}  // namespace
}  // namespace saccade
