#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"

namespace saccade {

/// EVT 3.0 of Prophesee's cameras: 16-bit words that state only what changes: the row, the upper or
/// lower 12 bits of the time in us, the column and polarity of one event, or of those of up to 12
/// columns by a mask. What comes before the first upper bits has no time and is left out. The 24
/// bits wrap every 16.8 s; upper bits that decrease by more than half of their range are a wrap.
/// InputError with "FILE:byte OFFSET".
[[nodiscard]] std::unique_ptr<EventReader> open_evt3(const std::filesystem::path& file,
                                                     SensorSize size, TimeWindow window);

/// Times are rounded to us; those of a later hour than the first count from the second before the
/// first event, which the header states. InputError for coordinates above 2047.
[[nodiscard]] std::unique_ptr<EventWriter> make_evt3_writer(const std::filesystem::path& file,
                                                            TimestampUnit unit, SensorSize sensor);

}  // namespace saccade
