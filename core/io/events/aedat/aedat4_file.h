#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/events/aedat/flatbuffer.h"
#include "core/io/events/event_file.h"
#include "core/io/files/byte_reader.h"
#include "core/io/files/compression.h"

namespace saccade {

constexpr std::string_view kAedat4Magic = "#!AER-DAT4.0\r\n";

/// A stream of an AEDAT4 file: its packets carry its number.
struct Aedat4Stream {
  int id = 0;
  std::string type;   ///< "EVTS", "FRME", "IMUS", "TRIG"
  SensorSize sensor;  ///< 0 where it is not stated
};

/// A packet, unpacked: a FlatBuffer of the type of its stream.
struct Aedat4Packet {
  const Aedat4Stream* stream = nullptr;
  std::span<const std::byte> buffer;
  std::uint64_t offset = 0;  ///< in the file
};

/// AEDAT 4.0 of iniVation: a header with a description of the streams in XML, then packets of all
/// streams as they came, each compressed by itself. InputError with "FILE:byte OFFSET".
class Aedat4File {
 public:
  explicit Aedat4File(const std::filesystem::path& file);

  [[nodiscard]] const std::vector<Aedat4Stream>& streams() const { return header_.streams; }
  /// The next packet of the stream, valid until the next call; nullopt at the end.
  [[nodiscard]] std::optional<Aedat4Packet> next(int stream_id);
  /// next() goes on with the packet of this offset, or with the first one.
  void seek(std::uint64_t offset) { bytes_.seek(offset); }
  void rewind() { bytes_.seek(first_); }
  [[nodiscard]] const ByteReader& bytes() const { return bytes_; }

 private:
  struct Header {
    Unpacker::Method method = Unpacker::Method::kNone;
    std::int64_t table = -1;  ///< where a table of the packets stands behind them; -1: nowhere
    std::vector<Aedat4Stream> streams;
  };
  [[nodiscard]] Header read_header();
  ByteReader bytes_;
  Header header_;
  std::uint64_t first_ = 0;  ///< where the packets begin
  std::uint64_t end_ = 0;    ///< and end
  Unpacker unpacker_;
};

/// The streams that the XML of a header describes.
[[nodiscard]] std::vector<Aedat4Stream> parse_aedat4_streams(std::string_view xml);

}  // namespace saccade
