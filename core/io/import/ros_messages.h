#pragma once

#include <optional>

#include "core/camera.h"
#include "core/image.h"
#include "core/imu_sample.h"
#include "core/io/ros/bag_file.h"
#include "core/trajectory.h"

namespace saccade {

// Messages of ROS 1 in the words of this project. A malformed one fails with its place.

[[nodiscard]] ImuSample read_imu_message(BagMessageReader& message);
[[nodiscard]] StampedPose read_pose_message(BagMessageReader& message);
/// nullopt where it is not calibrated. Fails for lens models other than plumb_bob.
[[nodiscard]] std::optional<PinholeCamera> read_camera_message(BagMessageReader& message);

struct StampedPicture {
  TimeNs t_ns = 0;
  ImageU8 grey;
};
/// Of the encodings mono8, 8UC1, rgb8 and bgr8.
[[nodiscard]] StampedPicture read_image_message(BagMessageReader& message);

}  // namespace saccade
