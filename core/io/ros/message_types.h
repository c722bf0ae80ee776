#pragma once

#include <string>
#include <string_view>

namespace saccade {

/// The definition of a type of messages that is written here, "sensor_msgs/Image", with those of the
/// types that it holds, as connections of bags (ROS 1) and schemas of MCAP (ROS 2, "ros2msg") state
/// them. Known by name (contract).
[[nodiscard]] std::string ros1_definition(std::string_view type);
[[nodiscard]] std::string ros2_definition(std::string_view type);

/// The MD5 by which ROS 1 tells whether two programs mean the same type (genmsg): of the definition
/// without comments, constants first, types replaced by their own MD5.
[[nodiscard]] std::string ros1_md5(std::string_view type);

/// "sensor_msgs/Image" -> "sensor_msgs/msg/Image".
[[nodiscard]] std::string ros2_type_name(std::string_view type);

}  // namespace saccade
