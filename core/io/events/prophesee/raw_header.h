#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/io/events/event_file.h"
#include "core/io/files/byte_reader.h"

namespace saccade {

/// Encodings of the data in files of Prophesee's cameras.
enum class RawEncoding { kUnknown, kEvt2, kEvt21, kEvt3, kDat };

/// The text at the beginning of such a file: lines `% KEY VALUE`, of which the last may be `% end`.
/// The data begin behind it.
struct RawHeader {
  RawEncoding encoding = RawEncoding::kUnknown;
  SensorSize sensor;           ///< 0 where neither stated nor known of the camera's plug-in
  std::string endianness;      ///< "little", "legacy", "big"; empty where it is not stated
  std::int64_t origin_us = 0;  ///< is added to all times; a key of this project's own files
  std::size_t bytes = 0;       ///< of the header
};

/// Of the file that begins with `head`; a size that is no number counts as not stated.
[[nodiscard]] RawHeader parse_raw_header(std::string_view head);

/// Reads the header and moves `bytes` behind it.
[[nodiscard]] RawHeader read_raw_header(ByteReader& bytes);

/// "% evt 3.0\n% format EVT3;height=180;width=240\n% geometry 240x180\n% end\n"; without the size
/// where `sensor` is unknown.
[[nodiscard]] std::string raw_header_text(RawEncoding encoding, SensorSize sensor,
                                          std::int64_t origin_us);

}  // namespace saccade
