#pragma once

#include <filesystem>
#include <memory>

#include "core/io/events/event_file.h"

namespace saccade {

/// EVT 2.0 of Prophesee's cameras: 32-bit words with an event and the lower 6 bits of its time in
/// us, or with the upper 28 bits. What comes before the first of the latter is left out.
/// InputError with "FILE:byte OFFSET".
[[nodiscard]] std::unique_ptr<EventReader> open_evt2(const std::filesystem::path& file,
                                                     SensorSize size, TimeWindow window);

/// Likewise; see make_evt3_writer().
[[nodiscard]] std::unique_ptr<EventWriter> make_evt2_writer(const std::filesystem::path& file,
                                                            TimestampUnit unit, SensorSize sensor);

/// EVT 2.1: 64-bit words, half of which is a word of EVT 2.0 and the other a mask of 32 columns
/// from its own on. The order of the halves is stated by the header's `endianness` ("little": mask
/// first, "legacy": last), or else found by the types of the first words.
[[nodiscard]] std::unique_ptr<EventReader> open_evt21(const std::filesystem::path& file,
                                                      SensorSize size, TimeWindow window);

/// DAT: a 32-bit time in us, which wraps every 71.6 min, and 14 bits each of column and row.
[[nodiscard]] std::unique_ptr<EventReader> open_dat(const std::filesystem::path& file,
                                                    SensorSize size, TimeWindow window);

}  // namespace saccade
