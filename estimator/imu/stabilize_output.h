#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/event.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/stabilized_events.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "estimator/imu/stabilizer.h"

namespace saccade {

/// Events that were turned to one orientation.
struct StabilizedStretch {
  StabilizedWindow window;
  std::span<const Event> events;
  std::vector<StabilizedEvent> stabilized;  ///< as many
};

/// events.h5 with the events whose nearest pixel is in the image, places.h5 and windows.csv.
void write_stabilized_events(const std::filesystem::path& folder, const PinholeCamera& camera,
                             std::span<const StabilizedStretch> stretches);

/// frames/frame_*.png of the dataset's frames within the window, as 8-bit sRGB, and images.txt.
/// Nothing where there are none.
void write_stabilized_frames(const std::filesystem::path& folder, const Dataset& dataset,
                             const RunRecord::Window& window, const Stabilizer& stabilizer,
                             const Trajectory& world_from_steady);

}  // namespace saccade
