#include "core/io/ros/mcap_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <utility>

namespace saccade {
namespace {

/// "sensor_msgs/msg/Image" -> "sensor_msgs/Image".
std::string ros1_name(std::string name) {
  constexpr std::string_view kMiddle = "/msg/";
  if (const std::size_t at = name.find(kMiddle); at != std::string::npos)
    name.erase(at, kMiddle.size() - 1);
  return name;
}

bool is_text_equal(std::span<const std::byte> bytes, std::string_view text) {
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()) == text;
}

}  // namespace

std::string_view McapFields::text() {
  const auto part = take(number<std::uint32_t>());
  return {reinterpret_cast<const char*>(part.data()), part.size()};
}

std::span<const std::byte> McapFields::take(std::uint64_t count) {
  if (count > rest_.size()) throw McapError{"a record ends too early; the file is damaged"};
  const auto size = static_cast<std::size_t>(count);
  return std::exchange(rest_, rest_.subspan(size)).first(size);
}

McapFile::McapFile(const std::filesystem::path& file) : bytes_(file) {
  if (!is_text_equal(bytes_.take(kMcapMagic.size(), "the first bytes"), kMcapMagic))
    bytes_.fail(0, "is no MCAP of version 0, which begins with the bytes 89 4d 43 41 50 30 0d 0a");
}

std::optional<Message> McapFile::next() {
  try {
    return next_unplaced();
  } catch (const McapError& error) {
    bytes_.fail(offset_, error.problem);
  } catch (const CompressionError& error) {
    bytes_.fail(offset_, "in the chunk that begins here: " + error.problem);
  }
}

std::optional<Message> McapFile::next_unplaced() {
  while (true) {
    if (const auto inner = read_record_of_chunk()) {
      if (auto message = take(*inner)) return message;
      continue;
    }
    if (is_over_) return std::nullopt;
    const Record record = read_record();
    switch (record.op) {
      case McapOp::kChunk:
        open_chunk(McapFields(record.content));
        break;
      case McapOp::kDataEnd:
      case McapOp::kFooter:
        is_over_ = true;
        break;
      default:
        if (auto message = take(record)) return message;
    }
  }
}

McapFile::Record McapFile::read_record() {
  offset_ = bytes_.offset();
  if (bytes_.left() == 0)
    bytes_.fail(offset_,
                "the file ends without the record that closes it, as where a recording was cut "
                "off; `mcap recover` of mcap.dev repairs it");
  constexpr std::size_t kHeadBytes = 1 + sizeof(std::uint64_t);
  const auto head = bytes_.take(kHeadBytes, "the head of a record");
  const auto op = static_cast<McapOp>(std::to_integer<std::uint8_t>(head[0]));
  return {op, bytes_.take(load<std::uint64_t>(head.data() + 1), "a record")};
}

std::optional<McapFile::Record> McapFile::read_record_of_chunk() {
  if (chunk_.empty()) return std::nullopt;
  McapFields fields(chunk_);
  const auto op = static_cast<McapOp>(fields.number<std::uint8_t>());
  const auto content = fields.take(fields.number<std::uint64_t>());
  chunk_ = fields.rest();
  return Record{op, content};
}

void McapFile::open_chunk(McapFields fields) {
  static_cast<void>(fields.take(2 * sizeof(std::uint64_t)));  // the first and the last time
  const auto size = fields.number<std::uint64_t>();
  const auto checksum = fields.number<std::uint32_t>();
  const std::string_view compression = fields.text();
  const auto packed = fields.take(fields.number<std::uint64_t>());
  if (compression.empty()) {
    plain_.assign(packed.begin(), packed.end());
    chunk_ = plain_;
  } else if (compression == "lz4") {
    chunk_ = lz4_.unpack(packed);
  } else if (compression == "zstd") {
    chunk_ = zstd_.unpack(packed);
  } else {
    throw McapError{
        fmt::format("the chunk is compressed by '{}'; lz4 and zstd can be unpacked", compression)};
  }
  if (chunk_.size() != size)
    throw McapError{
        fmt::format("the chunk unpacks to {} bytes instead of {}", chunk_.size(), size)};
  const auto found = crc32_z(0, reinterpret_cast<const Bytef*>(chunk_.data()), chunk_.size());
  if (checksum != 0 && found != checksum)
    throw McapError{
        fmt::format("the checksum of the chunk is {:08x} instead of {:08x}; the file "
                    "is damaged",
                    found, checksum)};
}

std::optional<Message> McapFile::take(const Record& record) {
  McapFields fields(record.content);
  if (record.op == McapOp::kSchema) {
    const auto id = fields.number<std::uint16_t>();
    Schema schema;
    schema.name = fields.text();
    schema.encoding = fields.text();
    schemas_.try_emplace(id, std::move(schema));
  } else if (record.op == McapOp::kChannel) {
    add_channel(fields);
  } else if (record.op == McapOp::kMessage) {
    const auto channel = fields.number<std::uint16_t>();
    static_cast<void>(fields.take(sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t)));
    const auto topic = topics_.find(channel);
    if (topic == topics_.end())
      throw McapError{fmt::format("a message of the unknown channel {}", channel)};
    return Message{&topic->second, fields.rest(), offset_};
  }
  return std::nullopt;
}

void McapFile::add_channel(McapFields fields) {
  const auto id = fields.number<std::uint16_t>();
  const auto schema = schemas_.find(fields.number<std::uint16_t>());
  MessageTopic topic;
  topic.name = fields.text();
  const std::string_view encoding = fields.text();
  topic.serialisation = encoding == "ros1"  ? Serialisation::kRos1
                        : encoding == "cdr" ? Serialisation::kCdr
                                            : Serialisation::kOther;
  if (schema != schemas_.end()) topic.type = ros1_name(schema->second.name);
  topics_.try_emplace(id, std::move(topic));
}

std::vector<const MessageTopic*> McapFile::topics() const {
  std::vector<const MessageTopic*> list;
  for (const auto& [id, topic] : topics_) list.push_back(&topic);
  return list;
}

InputError McapFile::error_in(const Message& message, const std::string& problem) const {
  return {fmt::format("{}:byte {}", name(), message.place),
          "in the record that begins here: " + problem};
}

}  // namespace saccade
