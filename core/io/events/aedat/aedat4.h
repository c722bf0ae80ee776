#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"

namespace saccade {

/// The events of an AEDAT4 file (aedat4_file.h): those of its stream of events, or of the first one
/// with a notice where it has several.
[[nodiscard]] std::unique_ptr<EventReader> open_aedat4(const std::filesystem::path& file,
                                                       SensorSize size, TimeWindow window);

/// Times are rounded to us; packets of 16384 events are compressed by LZ4. InputError for
/// coordinates above 32767.
[[nodiscard]] std::unique_ptr<EventWriter> make_aedat4_writer(const std::filesystem::path& file,
                                                              TimestampUnit unit,
                                                              SensorSize sensor);

}  // namespace saccade
