#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"

namespace saccade {

/// The events of an AEDAT 2.0 file of jAER, of a camera of the DAVIS family; its frames and
/// inertial samples are left out. jAER counts columns from the right and rows from the bottom: here
/// they count from the upper left, as everywhere. The 32-bit time in us wraps every 71.6 min.
/// InputError with "FILE:byte OFFSET", also where the header names no DAVIS.
[[nodiscard]] std::unique_ptr<EventReader> open_aedat2(const std::filesystem::path& file,
                                                       SensorSize size, TimeWindow window);

}  // namespace saccade
