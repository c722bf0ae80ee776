#pragma once

#include <cstdint>
#include <filesystem>

#include "core/io/import/public_sequence.h"

namespace saccade {

/// How much of a bag became a dataset.
struct BagCounts {
  std::uint64_t events = 0;
  std::uint64_t frames = 0;
  std::uint64_t imu_samples = 0;
  std::uint64_t poses = 0;
};

/// Writes a bag of ROS 1 (bag_file.h) as a dataset folder: events, sensor_msgs/Imu (imu.txt),
/// sensor_msgs/Image (frames; their codes count as sRGB) and geometry_msgs/PoseStamped
/// (groundtruth.txt, as they are). `path` may name the topic of the events, "FILE!/topic"; of the
/// other types, that topic counts whose name has most in common with it. The camera is that of
/// sensor_msgs/CameraInfo, or of calib.txt beside the bag; InputError where there is neither.
[[nodiscard]] BagCounts write_bag_as_dataset(const std::filesystem::path& path,
                                             const std::filesystem::path& folder,
                                             const ImportWindow& window = {});

/// Whether a file, or the file of "FILE!/topic", is a bag.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

}  // namespace saccade
