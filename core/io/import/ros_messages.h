#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/camera.h"
#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/ros/message_file.h"
#include "core/trajectory.h"

namespace saccade {

// Messages of ROS 1 and 2 in the words of this project. A malformed one fails with its place.

/// sensor_msgs/Imu.
[[nodiscard]] ImuSample read_imu_message(MessageReader& message);

/// Whether messages of this type are poses: geometry_msgs/PoseStamped, geometry_msgs/TransformStamped
/// or nav_msgs/Odometry.
[[nodiscard]] bool holds_poses(const MessageTopic& topic);
/// As it is, of the frame that the message is about.
[[nodiscard]] StampedPose read_pose_message(const MessageTopic& topic, MessageReader& message);

/// sensor_msgs/CameraInfo; nullopt where it is not calibrated. Fails for lens models other than
/// plumb_bob.
[[nodiscard]] std::optional<PinholeCamera> read_camera_message(MessageReader& message);

/// What a sensor_msgs/Image holds; `data` as long as the message.
struct ImageMessage {
  enum class Kind { kGrey, kColour, kDepth, kOther };

  TimeNs t_ns = 0;
  std::uint32_t width = 0;   ///< [px]
  std::uint32_t height = 0;  ///< [px]
  std::string encoding;
  std::uint32_t row_bytes = 0;
  std::span<const std::byte> data;

  /// mono8 and 8UC1, rgb8 and bgr8, 32FC1 (depth [m]) and 16UC1 (depth [mm]).
  [[nodiscard]] Kind kind() const;
  [[nodiscard]] bool is_picture() const { return kind() == Kind::kGrey || kind() == Kind::kColour; }
};
[[nodiscard]] ImageMessage read_image_message(MessageReader& message);
/// Codes of a picture as grey ones; its kind must be one (contract).
[[nodiscard]] ImageU8 grey_of(const ImageMessage& image);
/// z depth [m], 0 = unknown, as which NaN and negative values count as well; likewise.
[[nodiscard]] ImageF depth_of(const ImageMessage& image);

}  // namespace saccade
