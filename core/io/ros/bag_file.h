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

namespace saccade {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// A topic of a bag and the type of its messages, e.g. "dvs_msgs/EventArray".
struct BagTopic {
  std::string name;
  std::string type;
};

/// A message as it was serialised; valid until the next call of BagFile::next().
struct BagMessage {
  const BagTopic* topic = nullptr;
  std::span<const std::byte> data;
  std::uint64_t offset = 0;  ///< in the file, of the record or chunk that holds it
};

/// The messages of a bag of ROS 1 (wiki.ros.org/Bags/Format/2.0), from front to back, one chunk in
/// memory at a time; the index at the end is not needed. Chunks may be plain, bz2 or lz4.
/// InputError with "FILE:byte OFFSET".
class BagFile {
 public:
  explicit BagFile(const std::filesystem::path& file);

  /// The next message; nullopt at the end.
  [[nodiscard]] std::optional<BagMessage> next();
  /// The topics of the connections that were seen so far, by their number.
  [[nodiscard]] const std::map<std::uint32_t, BagTopic>& topics() const { return topics_; }
  [[nodiscard]] const ByteReader& bytes() const { return bytes_; }

 private:
  struct Record {
    std::span<const std::byte> header;
    std::span<const std::byte> data;
  };

  [[nodiscard]] Record read_record();
  [[nodiscard]] std::optional<Record> read_record_of_chunk();
  void open_chunk(const Record& record);
  [[nodiscard]] std::optional<BagMessage> take(const Record& record);
  void connect(const Record& record);
  [[nodiscard]] std::span<const std::byte> field(std::span<const std::byte> header,
                                                 std::string_view name) const;
  template <class T>
  [[nodiscard]] T number(std::span<const std::byte> header, std::string_view name) const;
  [[noreturn]] void fail(const std::string& problem) const { bytes_.fail(offset_, problem); }

  ByteReader bytes_;
  std::uint64_t offset_ = 0;  ///< of the current record
  std::vector<std::byte> record_header_;
  std::vector<std::byte> plain_;
  std::map<std::string, Unpacker, std::less<>> unpackers_;
  std::span<const std::byte> chunk_;  ///< what is left of it
  std::map<std::uint32_t, BagTopic> topics_;
};

/// The bytes of a message from front to back. What lies behind its end fails.
class BagMessageReader {
 public:
  BagMessageReader(const ByteReader& bytes, const BagMessage& message)
      : bytes_(bytes), message_(message), rest_(message.data) {}

  template <class T>
  [[nodiscard]] T number() {
    return load<T>(take(sizeof(T)).data());
  }
  [[nodiscard]] TimeNs time() {
    const auto seconds = number<std::uint32_t>();
    return TimeNs{seconds} * 1'000'000'000 + number<std::uint32_t>();
  }
  [[nodiscard]] std::string_view text() {
    const auto part = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(part.data()), part.size()};
  }
  /// A std_msgs/Header; its time.
  [[nodiscard]] TimeNs header();
  [[nodiscard]] std::span<const std::byte> take(std::size_t count);
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  const ByteReader& bytes_;
  const BagMessage& message_;
  std::span<const std::byte> rest_;
};

}  // namespace saccade
