#pragma once

#include <filesystem>

#include "core/io/import/public_sequence.h"

namespace saccade {

/// Writes a dataset folder as a recording of ROS (message_writer.h), by the ending of `file`: below
/// /dvs its events, frames (image_raw), inertial samples (imu), camera_info, poses (pose) and depth
/// (depth). An MCAP holds beside them what a viewer shows: /view/events, pictures of the events of
/// each 1/30 s, /view/points, the points of each depth map in the world, and /tf. In order of time.
/// What is before time 0, which ROS cannot state, is left out with a notice.
ImportCounts write_ros_export(const std::filesystem::path& dataset,
                              const std::filesystem::path& file);

}  // namespace saccade
