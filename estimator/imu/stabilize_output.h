#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/stabilized_events.h"
#include "core/io/run/run_record.h"
#include "core/trajectory.h"
#include "estimator/imu/stabilizer.h"

namespace saccade {

/// Writes events.h5 with the events whose nearest pixel is in the image, places.h5 and windows.csv,
/// window by window.
class StabilizedEventsWriter {
 public:
  StabilizedEventsWriter(const std::filesystem::path& folder, const PinholeCamera& camera);

  /// The next windows and the events of each, in order of time.
  void append(std::span<const StabilizedWindow> windows,
              std::span<const std::vector<StabilizedEvent>> stabilized);
  void close();

 private:
  std::filesystem::path folder_;
  PinholeCamera camera_;
  EventH5Writer events_;
  StabilizedCoordinatesWriter places_;
  std::vector<StabilizedWindow> windows_;
};

/// Writes frames/frame_*.png for the dataset's frames within the window, as 8-bit sRGB, and
/// images.txt; nothing where there are none.
void write_stabilized_frames(const std::filesystem::path& folder, const Dataset& dataset,
                             const RunRecord::Window& window, const Stabilizer& stabilizer,
                             const Trajectory& world_from_smoothed);

}  // namespace saccade
