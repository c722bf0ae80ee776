#include "core/io/events/aedat/aedat4_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"

namespace saccade {
namespace {

// Fields of the header's table.
constexpr unsigned kCompressionField = 0;
constexpr unsigned kTableField = 1;
constexpr unsigned kDescriptionField = 2;

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 24U;

Unpacker::Method method_of(const FlatTable& header) {
  switch (const auto code = header.number<std::int32_t>(kCompressionField, 0)) {
    case 0:
      return Unpacker::Method::kNone;
    case 1:
    case 2:
      return Unpacker::Method::kLz4;
    case 3:
    case 4:
      return Unpacker::Method::kZstd;
    default:
      throw FlatBufferError{
          fmt::format("the compression has the unknown number {}; it must be 0 "
                      "(none), 1 or 2 (LZ4), 3 or 4 (Zstandard)",
                      code)};
  }
}

template <class Integer>
void parse_into(std::string_view text, Integer& value) {
  Integer parsed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error == std::errc() && end == text.data() + text.size()) value = parsed;
}

/// The value of `name="..."` within a tag; empty where the tag has none.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string key = " " + std::string(name) + "=\"";
  const std::size_t begin = tag.find(key);
  if (begin == std::string_view::npos) return {};
  const std::string_view rest = tag.substr(begin + key.size());
  return rest.substr(0, std::min(rest.find('"'), rest.size()));
}

/// `text` of <attr key="KEY">TEXT</attr> below the nodes `path`.
void read_attribute(const std::vector<std::string_view>& path, std::string_view key,
                    std::string_view text, std::vector<Aedat4Stream>& streams) {
  const auto outputs = std::find(path.begin(), path.end(), "outInfo");
  if (path.end() - outputs < 2) return;
  int id = -1;
  parse_into(*(outputs + 1), id);
  if (id < 0) return;
  auto stream = std::find_if(streams.begin(), streams.end(),
                             [&](const Aedat4Stream& other) { return other.id == id; });
  if (stream == streams.end())
    stream = streams.insert(streams.end(), {.id = id, .type = {}, .sensor = {}});
  if (key == "typeIdentifier") stream->type = text;
  if (key == "sizeX") parse_into(text, stream->sensor.width);
  if (key == "sizeY") parse_into(text, stream->sensor.height);
}

}  // namespace

std::vector<Aedat4Stream> parse_aedat4_streams(std::string_view xml) {
  std::vector<Aedat4Stream> streams;
  std::vector<std::string_view> path;
  while (true) {
    const std::size_t begin = std::min(xml.find('<'), xml.size());
    const std::size_t end = xml.find('>', begin);
    if (end == std::string_view::npos) return streams;
    const std::string_view tag = xml.substr(begin, end - begin);
    xml.remove_prefix(end + 1);
    if (tag.starts_with("<node") && !tag.ends_with('/')) path.push_back(attribute(tag, "name"));
    if (tag.starts_with("</node") && !path.empty()) path.pop_back();
    if (tag.starts_with("<attr"))
      read_attribute(path, attribute(tag, "key"),
                     xml.substr(0, std::min(xml.find('<'), xml.size())), streams);
  }
}

Aedat4File::Aedat4File(const std::filesystem::path& file)
    : bytes_(file), header_(read_header()), unpacker_(header_.method) {
  if (header_.table > static_cast<std::int64_t>(bytes_.size()))
    bytes_.fail(bytes_.size(), fmt::format("the file ends early: its packets end at byte {} by its "
                                           "header",
                                           header_.table));
  first_ = bytes_.offset();
  end_ = header_.table < 0 ? bytes_.size() : static_cast<std::uint64_t>(header_.table);
}

Aedat4File::Header Aedat4File::read_header() {
  const auto magic = bytes_.take(kAedat4Magic.size(), "the first line");
  if (!std::equal(magic.begin(), magic.end(), kAedat4Magic.begin(),
                  [](std::byte a, char b) { return a == static_cast<std::byte>(b); }))
    bytes_.fail(0, "is no AEDAT 4.0, which begins with the line \"#!AER-DAT4.0\"");
  const std::uint64_t offset = bytes_.offset();
  const auto size = load<std::uint32_t>(bytes_.take(sizeof(std::uint32_t), "the header").data());
  bytes_.seek(offset);
  if (size > kMostHeaderBytes)
    bytes_.fail(offset, fmt::format("the header claims {} bytes; it is damaged", size));
  const auto sized = bytes_.take(size + sizeof size, "the header");
  try {
    const FlatTable table = FlatTable::root(sized, "IOHE");
    return {method_of(table), table.number<std::int64_t>(kTableField, -1),
            parse_aedat4_streams(table.text(kDescriptionField))};
  } catch (const FlatBufferError& error) {
    bytes_.fail(offset, "the header is damaged: " + error.problem);
  }
}

std::optional<Aedat4Packet> Aedat4File::next(int stream_id) {
  constexpr std::size_t kHeadBytes = 2 * sizeof(std::int32_t);
  while (bytes_.offset() < end_) {
    const std::uint64_t offset = bytes_.offset();
    const auto head = bytes_.take(kHeadBytes, "the head of a packet");
    const auto id = load<std::int32_t>(head.data());
    const auto size = load<std::int32_t>(head.data() + sizeof id);
    const auto stream = std::find_if(header_.streams.begin(), header_.streams.end(),
                                     [&](const Aedat4Stream& s) { return s.id == id; });
    if (stream == header_.streams.end() || size < 0 ||
        static_cast<std::uint64_t>(size) > end_ - bytes_.offset())
      bytes_.fail(offset, fmt::format("a packet of {} bytes of stream {} cannot begin here, where "
                                      "{} bytes are left; the file is damaged or ends early",
                                      size, id, end_ - bytes_.offset()));
    if (id != stream_id) {
      bytes_.seek(bytes_.offset() + static_cast<std::uint64_t>(size));
      continue;
    }
    try {
      const auto packed = bytes_.take(static_cast<std::uint64_t>(size), "a packet");
      return Aedat4Packet{&*stream, unpacker_.unpack(packed), offset};
    } catch (const CompressionError& error) {
      bytes_.fail(offset, error.problem);
    }
  }
  return std::nullopt;
}

}  // namespace saccade
