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

#include "core/event.h"
#include "core/io/files/byte_reader.h"
#include "core/io/files/compression.h"
#include "core/io/ros/message_file.h"

namespace saccade {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// The messages of a bag of ROS 1 (wiki.ros.org/Bags/Format/2.0), from front to back, one chunk in
/// memory at a time; the index at the end is not needed. Chunks may be plain, bz2 or lz4.
/// InputError with "FILE:byte OFFSET".
class BagFile final : public MessageFile {
 public:
  explicit BagFile(const std::filesystem::path& file);

  [[nodiscard]] std::optional<Message> next() override;
  [[nodiscard]] std::vector<const MessageTopic*> topics() const override;
  [[nodiscard]] const std::string& name() const override { return bytes_.name(); }
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  /// At the record, or at the chunk that holds it.
  [[nodiscard]] InputError error_in(const Message& message,
                                    const std::string& problem) const override;

 private:
  struct Record {
    std::span<const std::byte> header;
    std::span<const std::byte> data;
  };

  [[nodiscard]] Record read_record();
  [[nodiscard]] std::optional<Record> read_record_of_chunk();
  void open_chunk(const Record& record);
  [[nodiscard]] std::optional<Message> take(const Record& record);
  void connect(const Record& record);
  [[nodiscard]] std::span<const std::byte> field(std::span<const std::byte> header,
                                                 std::string_view name) const;
  template <class T>
  [[nodiscard]] T number(std::span<const std::byte> header, std::string_view name) const;
  [[noreturn]] void fail_here(const std::string& problem) const { bytes_.fail(offset_, problem); }

  ByteReader bytes_;
  std::uint64_t offset_ = 0;  ///< of the current record
  std::vector<std::byte> record_header_;
  std::vector<std::byte> plain_;
  std::map<std::string, Unpacker, std::less<>> unpackers_;
  std::span<const std::byte> chunk_;  ///< what is left of it
  std::map<std::uint32_t, MessageTopic> topics_;
};

}  // namespace saccade
