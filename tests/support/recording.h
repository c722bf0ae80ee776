#pragma once

#include <filesystem>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"
#include "core/trajectory.h"

namespace saccade::testing {

struct StampedPicture {
  double t_s = 0;
  ImageU8 picture;  ///< of the sensor's size
};

/// Writes a recording in the layout of the Event Camera Dataset: events.txt, calib.txt (without a
/// lens), images.txt with at least one picture, from which readers know the sensor's size, and
/// groundtruth.txt.
void write_recording(const std::filesystem::path& folder, const PinholeCamera& camera,
                     std::span<const Event> events, std::span<const StampedPicture> pictures,
                     std::span<const StampedPose> poses);

}  // namespace saccade::testing
