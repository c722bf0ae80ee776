#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/event.h"
#include "core/io/files/byte_reader.h"

namespace saccade {

/// How the messages of a topic are serialised: as ROS 1 does, in the Common Data Representation of
/// ROS 2, or otherwise, which cannot be read here.
enum class Serialisation { kRos1, kCdr, kOther };

/// A topic and the type of its messages as ROS 1 names it: "sensor_msgs/Image".
struct MessageTopic {
  std::string name;
  std::string type;
  Serialisation serialisation = Serialisation::kRos1;
};

/// A message as it was serialised; valid until the next call of MessageFile::next().
struct Message {
  const MessageTopic* topic = nullptr;
  std::span<const std::byte> data;
  std::uint64_t place = 0;  ///< where it stands, in the file's own way of counting
};

/// The messages of a recording from front to back, in memory that does not grow with the file.
class MessageFile {
 public:
  virtual ~MessageFile() = default;
  /// The next message; nullopt at the end. InputError with the place of what is damaged.
  [[nodiscard]] virtual std::optional<Message> next() = 0;
  /// Those that were seen so far; their addresses stay.
  [[nodiscard]] virtual std::vector<const MessageTopic*> topics() const = 0;
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Of the file [bytes].
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// What is thrown for a message: at "FILE:byte 5" or "FILE:message 5".
  [[nodiscard]] virtual InputError error_in(const Message& message,
                                            const std::string& problem) const = 0;
  [[noreturn]] void fail(const Message& message, const std::string& problem) const {
    throw error_in(message, problem);
  }
};

/// A bag of ROS 1, an MCAP file, a SQLite file of rosbag2 or its folder with metadata.yaml.
[[nodiscard]] std::unique_ptr<MessageFile> open_message_file(const std::filesystem::path& file);
/// Whether it is one of them, by its content.
[[nodiscard]] bool is_message_file(const std::filesystem::path& file);

/// The fields of a message from front to back. What lies behind its end fails.
class MessageReader {
 public:
  MessageReader(const MessageFile& file, const Message& message);

  template <class T>
  [[nodiscard]] T number() {
    align(sizeof(T));
    return load<T>(take(sizeof(T)).data());
  }
  [[nodiscard]] bool flag() { return number<std::uint8_t>() != 0; }
  [[nodiscard]] TimeNs time() {
    const auto seconds = number<std::uint32_t>();
    return TimeNs{seconds} * 1'000'000'000 + number<std::uint32_t>();
  }
  [[nodiscard]] std::string_view text();
  /// A std_msgs/Header; its time.
  [[nodiscard]] TimeNs header();
  /// The bytes of an array of bytes.
  [[nodiscard]] std::span<const std::byte> byte_array() { return take(number<std::uint32_t>()); }
  [[nodiscard]] std::span<const std::byte> take(std::size_t count);
  [[nodiscard]] bool is_cdr() const { return is_cdr_; }
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  /// In the Common Data Representation numbers lie at multiples of their size.
  void align(std::size_t size) {
    if (!is_cdr_) return;
    const auto used = static_cast<std::size_t>(rest_.data() - begin_);
    if (const std::size_t over = used % size; over != 0) static_cast<void>(take(size - over));
  }

  const MessageFile& file_;
  const Message& message_;
  std::span<const std::byte> rest_;
  const std::byte* begin_;
  bool is_cdr_;
};

}  // namespace saccade
