#include "core/io/ros/bag_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace saccade {
namespace {

enum class Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

BagFile::BagFile(const std::filesystem::path& file) : bytes_(file) {
  if (as_text(bytes_.take(kBagMagic.size(), "the first line")) != kBagMagic)
    bytes_.fail(0, "is no bag of ROS 1, which begins with the line \"#ROSBAG V2.0\"");
  unpackers_.try_emplace("none", Unpacker::Method::kNone);
  unpackers_.try_emplace("lz4", Unpacker::Method::kLz4);
  unpackers_.try_emplace("bz2", Unpacker::Method::kBzip2);
}

std::optional<Message> BagFile::next() {
  while (true) {
    if (const auto inner = read_record_of_chunk()) {
      if (auto message = take(*inner)) return message;
      continue;
    }
    if (bytes_.left() == 0) return std::nullopt;
    const Record record = read_record();
    if (number<std::uint8_t>(record.header, "op") == static_cast<std::uint8_t>(Op::kChunk))
      open_chunk(record);
    else if (auto message = take(record))
      return message;
  }
}

BagFile::Record BagFile::read_record() {
  offset_ = bytes_.offset();
  const auto size_of = [&](std::string_view what) {
    return load<std::uint32_t>(bytes_.take(sizeof(std::uint32_t), what).data());
  };
  const auto header = bytes_.take(size_of("a record"), "the header of a record");
  record_header_.assign(header.begin(), header.end());
  // The data are the last that is taken, so that they stay valid.
  return {record_header_, bytes_.take(size_of("a record"), "the data of a record")};
}

std::optional<BagFile::Record> BagFile::read_record_of_chunk() {
  if (chunk_.empty()) return std::nullopt;
  const auto part = [&] {
    if (chunk_.size() < sizeof(std::uint32_t)) fail_here("the chunk ends within a record");
    const auto size = load<std::uint32_t>(chunk_.data());
    chunk_ = chunk_.subspan(sizeof size);
    if (size > chunk_.size()) fail_here("the chunk ends within a record");
    return std::exchange(chunk_, chunk_.subspan(size)).first(size);
  };
  const auto header = part();
  return Record{header, part()};
}

void BagFile::open_chunk(const Record& record) {
  const std::string_view compression = as_text(field(record.header, "compression"));
  const auto unpacker = unpackers_.find(compression);
  if (unpacker == unpackers_.end())
    fail_here(fmt::format("the chunk is compressed by '{}'; none, bz2 and lz4 can be unpacked",
                          compression));
  try {
    chunk_ = unpacker->second.unpack(record.data);
  } catch (const CompressionError& error) {
    fail_here("in the chunk that begins here: " + error.problem);
  }
  if (compression != "none") return;
  plain_.assign(chunk_.begin(), chunk_.end());
  chunk_ = plain_;
}

std::optional<Message> BagFile::take(const Record& record) {
  switch (static_cast<Op>(number<std::uint8_t>(record.header, "op"))) {
    case Op::kMessage: {
      const auto connection = number<std::uint32_t>(record.header, "conn");
      const auto topic = topics_.find(connection);
      if (topic == topics_.end())
        fail_here(fmt::format("a message of the unknown connection {}", connection));
      return Message{&topic->second, record.data, offset_};
    }
    case Op::kConnection:
      connect(record);
      return std::nullopt;
    case Op::kBagHeader:
    case Op::kIndex:
    case Op::kChunkInfo:
      return std::nullopt;
    default:
      fail_here("a record of an unknown kind; the file is damaged");
  }
}

void BagFile::connect(const Record& record) {
  const auto connection = number<std::uint32_t>(record.header, "conn");
  // A repetition of a connection keeps the address of its topic.
  topics_.try_emplace(connection, MessageTopic{std::string(as_text(field(record.header, "topic"))),
                                               std::string(as_text(field(record.data, "type"))),
                                               Serialisation::kRos1});
}

std::span<const std::byte> BagFile::field(std::span<const std::byte> header,
                                          std::string_view name) const {
  while (header.size() >= sizeof(std::uint32_t)) {
    const auto size = load<std::uint32_t>(header.data());
    header = header.subspan(sizeof size);
    if (size > header.size()) break;
    const std::string_view text = as_text(header.first(size));
    const std::size_t equals = text.find('=');
    if (equals != std::string_view::npos && text.substr(0, equals) == name)
      return header.subspan(equals + 1, size - equals - 1);
    header = header.subspan(size);
  }
  fail_here(fmt::format("a record without the field '{}'; the file is damaged", name));
}

template <class T>
T BagFile::number(std::span<const std::byte> header, std::string_view name) const {
  const auto value = field(header, name);
  if (value.size() != sizeof(T))
    fail_here(
        fmt::format("the field '{}' has {} bytes instead of {}", name, value.size(), sizeof(T)));
  return load<T>(value.data());
}

std::vector<const MessageTopic*> BagFile::topics() const {
  std::vector<const MessageTopic*> list;
  for (const auto& [connection, topic] : topics_) list.push_back(&topic);
  return list;
}

InputError BagFile::error_in(const Message& message, const std::string& problem) const {
  return {fmt::format("{}:byte {}", name(), message.place),
          "in the record that begins here: " + problem};
}

}  // namespace saccade
