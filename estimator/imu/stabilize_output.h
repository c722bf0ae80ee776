#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/events/stabilized_events.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "estimator/imu/stabilizer.h"

namespace saccade {

/// Writes events.h5 with the events whose nearest pixel is in the image, places.h5 and windows.csv.
/// `stabilized`: the events of each window.
void write_stabilized_events(const std::filesystem::path& folder, const PinholeCamera& camera,
                             std::span<const StabilizedWindow> windows,
                             std::span<const std::vector<StabilizedEvent>> stabilized);

/// Writes frames/frame_*.png for the dataset's frames within the window, as 8-bit sRGB, and
/// images.txt; nothing where there are none.
void write_stabilized_frames(const std::filesystem::path& folder, const Dataset& dataset,
                             const RunRecord::Window& window, const Stabilizer& stabilizer,
                             const Trajectory& world_from_smoothed);

}  // namespace saccade
