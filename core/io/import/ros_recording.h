#pragma once

#include <filesystem>

#include "core/io/import/public_sequence.h"

namespace saccade {

/// Writes a recording of ROS (message_file.h: a bag, an MCAP or a rosbag2) as a dataset folder:
/// events, sensor_msgs/Imu (imu.txt), sensor_msgs/Image (frames, whose codes count as sRGB, and
/// depth), and poses (groundtruth.txt, as they are). `path` may name the topic of the events,
/// "FILE!/topic"; of the other kinds, that topic counts whose name has most in common with it.
/// Pictures that cannot be read, or of another size than the camera, are left out with a notice. The
/// camera is that of `calibration` (camera_files.h), of sensor_msgs/CameraInfo, or of calib.txt
/// beside the recording; InputError where there is none.
ImportCounts write_ros_recording(const std::filesystem::path& path,
                                 const std::filesystem::path& folder,
                                 const ImportWindow& window = {},
                                 const std::filesystem::path& calibration = {});

/// Whether a file, or the file of "FILE!/topic", is one of them.
[[nodiscard]] bool is_ros_recording(const std::filesystem::path& path);

}  // namespace saccade
