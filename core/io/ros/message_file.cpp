#include "core/io/ros/message_file.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "core/io/ros/bag_file.h"
#include "core/io/ros/mcap_file.h"
#include "core/io/ros/rosbag2_file.h"

namespace saccade {
namespace {

struct MessageFormat {
  std::string_view magic;
  std::unique_ptr<MessageFile> (*open)(const std::filesystem::path&);
};

template <class File>
std::unique_ptr<MessageFile> open_as(const std::filesystem::path& file) {
  return std::make_unique<File>(file);
}

constexpr std::array<MessageFormat, 3> kMessageFormats{{{kBagMagic, open_as<BagFile>},
                                                        {kMcapMagic, open_as<McapFile>},
                                                        {kSqliteMagic, open_as<Rosbag2File>}}};

/// nullptr where the file is of none of them.
const MessageFormat* find_format(const std::filesystem::path& file) {
  std::array<char, 16> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  const std::string_view bytes(head.data(), static_cast<std::size_t>(stream.gcount()));
  for (const MessageFormat& format : kMessageFormats)
    if (bytes.starts_with(format.magic)) return &format;
  return nullptr;
}

}  // namespace

std::unique_ptr<MessageFile> open_message_file(const std::filesystem::path& file) {
  if (is_rosbag2_folder(file)) return std::make_unique<Rosbag2Folder>(file);
  const MessageFormat* format = find_format(file);
  // A file of another kind is refused as a bag would be, whose reader names what is missing.
  return format == nullptr ? std::make_unique<BagFile>(file) : format->open(file);
}

bool is_message_file(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) return is_rosbag2_folder(file);
  return std::filesystem::is_regular_file(file) && find_format(file) != nullptr;
}

MessageReader::MessageReader(const MessageFile& file, const Message& message)
    : file_(file),
      message_(message),
      rest_(message.data),
      begin_(message.data.data()),
      is_cdr_(message.topic->serialisation == Serialisation::kCdr) {
  if (message.topic->serialisation == Serialisation::kOther)
    fail("it is serialised neither by ROS 1 nor in the CDR of ROS 2");
  if (!is_cdr_) return;
  // The encapsulation: 00 01, plain CDR of little-endian numbers, and two bytes of options.
  constexpr std::size_t kEncapsulation = 4;
  const auto head = take(kEncapsulation);
  if (head[0] != std::byte{0} || head[1] != std::byte{1})
    fail(
        fmt::format("its CDR has the encapsulation {:02x} {:02x}; 00 01 can be read, plain and "
                    "little-endian",
                    std::to_integer<unsigned>(head[0]), std::to_integer<unsigned>(head[1])));
  begin_ = rest_.data();
}

std::string_view MessageReader::text() {
  const std::span<const std::byte> part = byte_array();
  std::string_view text(reinterpret_cast<const char*>(part.data()), part.size());
  if (is_cdr_ && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

TimeNs MessageReader::header() {
  if (!is_cdr_) static_cast<void>(number<std::uint32_t>());  // a count
  const TimeNs t_ns = time();
  static_cast<void>(text());  // the frame
  return t_ns;
}

std::span<const std::byte> MessageReader::take(std::size_t count) {
  if (count > rest_.size()) fail("it ends too early");
  return std::exchange(rest_, rest_.subspan(count)).first(count);
}

void MessageReader::fail(const std::string& problem) const {
  file_.fail(message_, fmt::format("in a message of {}: {}", message_.topic->name, problem));
}

}  // namespace saccade
