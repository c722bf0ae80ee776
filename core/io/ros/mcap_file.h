#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/files/byte_reader.h"
#include "core/io/files/compression.h"
#include "core/io/ros/message_file.h"

namespace saccade {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// Kinds of records (mcap.dev/spec).
enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// What a record is refused for; the reader adds where it stands.
struct McapError {
  std::string problem;
};

/// The fields of a record from front to back. What lies behind its end is a McapError.
class McapFields {
 public:
  explicit McapFields(std::span<const std::byte> bytes) : rest_(bytes) {}
  template <class T>
  [[nodiscard]] T number() {
    return load<T>(take(sizeof(T)).data());
  }
  [[nodiscard]] std::string_view text();
  [[nodiscard]] std::span<const std::byte> take(std::uint64_t count);
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

 private:
  std::span<const std::byte> rest_;
};

/// The messages of an MCAP file, one chunk in memory at a time; the summary at its end is not
/// needed. Chunks may be plain, LZ4 or Zstandard. InputError with "FILE:byte OFFSET", also where a
/// checksum is wrong or the file was not closed.
class McapFile final : public MessageFile {
 public:
  explicit McapFile(const std::filesystem::path& file);

  [[nodiscard]] std::optional<Message> next() override;
  [[nodiscard]] std::vector<const MessageTopic*> topics() const override;
  [[nodiscard]] const std::string& name() const override { return bytes_.name(); }
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  /// At the record, or at the chunk that holds it.
  [[nodiscard]] InputError error_in(const Message& message,
                                    const std::string& problem) const override;

 private:
  struct Record {
    McapOp op{};
    std::span<const std::byte> content;
  };
  struct Schema {
    std::string name;
    std::string encoding;
  };

  [[nodiscard]] std::optional<Message> next_unplaced();
  [[nodiscard]] Record read_record();
  [[nodiscard]] std::optional<Record> read_record_of_chunk();
  void open_chunk(McapFields fields);
  [[nodiscard]] std::optional<Message> take(const Record& record);
  void add_channel(McapFields fields);

  ByteReader bytes_;
  std::uint64_t offset_ = 0;  ///< of the current record of the file
  bool is_over_ = false;
  Unpacker lz4_{Unpacker::Method::kLz4};
  Unpacker zstd_{Unpacker::Method::kZstd};
  std::vector<std::byte> plain_;
  std::span<const std::byte> chunk_;  ///< what is left of it
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, MessageTopic> topics_;
};

}  // namespace saccade
