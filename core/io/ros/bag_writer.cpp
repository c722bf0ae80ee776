#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/io/files/atomic_file.h"
#include "core/io/files/byte_builder.h"
#include "core/io/ros/bag_file.h"
#include "core/io/ros/message_types.h"
#include "core/io/ros/message_writer.h"

namespace saccade {
namespace {

constexpr std::size_t kBagChunkBytes = std::size_t{768} << 10U;
/// The first record is padded, so that it can be written again with what is known at the end.
constexpr std::size_t kBagHeaderBytes = 4096;

std::uint64_t ros1_time(TimeNs t_ns) {
  return static_cast<std::uint64_t>(t_ns % 1'000'000'000) << 32U |
         static_cast<std::uint64_t>(t_ns / 1'000'000'000);
}

/// The fields of a record's header: "name=value" with its length.
class BagFields {
 public:
  BagFields& add(std::string_view name, std::string_view value) {
    fields_.put_sized(std::string(name) + "=" + std::string(value));
    return *this;
  }
  template <class T>
  BagFields& number(std::string_view name, T value) {
    return add(name, {reinterpret_cast<const char*>(&value), sizeof value});
  }
  [[nodiscard]] std::string_view text() const { return fields_.text(); }

 private:
  ByteBuilder fields_;
};

std::string bag_record_bytes(const BagFields& header, std::string_view data) {
  ByteBuilder record;
  record.put_sized(header.text());
  record.put_sized(data);
  return std::string(record.text());
}

class BagFileWriter final : public MessageFileWriter {
 public:
  explicit BagFileWriter(const std::filesystem::path& file)
      : target_(file), stream_(target_.path(), std::ios::binary) {
    put(kBagMagic);
    put(file_header(0));
  }

  unsigned add_topic(std::string_view name, std::string_view type) override {
    const auto number = static_cast<std::uint32_t>(connections_.size());
    BagFields header;
    header.number<std::uint8_t>("op", 0x07).number("conn", number).add("topic", name);
    BagFields data;
    data.add("topic", name).add("type", type).add("md5sum", ros1_md5(type));
    data.add("message_definition", ros1_definition(type));
    connections_.push_back(bag_record_bytes(header, data.text()));
    chunk_.put_text(connections_.back());
    return number;
  }

  void write(unsigned topic, TimeNs t_ns, std::span<const std::byte> bytes) override {
    if (index_.empty()) chunk_start_ = chunk_end_ = t_ns;
    chunk_start_ = std::min(chunk_start_, t_ns);
    chunk_end_ = std::max(chunk_end_, t_ns);
    index_[topic].push_back({t_ns, static_cast<std::uint32_t>(chunk_.size())});
    BagFields header;
    header.number<std::uint8_t>("op", 0x02).number<std::uint32_t>("conn", topic);
    header.number("time", ros1_time(t_ns));
    chunk_.put_sized(header.text());
    chunk_.put(static_cast<std::uint32_t>(bytes.size()));
    chunk_.put_bytes(bytes);
    if (chunk_.size() >= kBagChunkBytes) flush();
  }

  void close() override {
    flush();
    const std::uint64_t index_at = position_;
    for (const std::string& connection : connections_) put(connection);
    for (const std::string& info : chunk_infos_) put(info);
    stream_.seekp(static_cast<std::streamoff>(kBagMagic.size()));
    put(file_header(index_at));
    stream_.close();
    if (!stream_) fail_to_write(target_.target(), errno);
    target_.commit();
  }

  [[nodiscard]] Serialisation serialisation() const override { return Serialisation::kRos1; }

 private:
  struct IndexEntry {
    TimeNs t_ns;
    std::uint32_t offset;
  };

  [[nodiscard]] std::string file_header(std::uint64_t index_at) const {
    BagFields header;
    header.number<std::uint8_t>("op", 0x03).number("index_pos", index_at);
    header.number("conn_count", static_cast<std::uint32_t>(connections_.size()));
    header.number("chunk_count", static_cast<std::uint32_t>(chunk_infos_.size()));
    const std::size_t used = 2 * sizeof(std::uint32_t) + header.text().size();
    return bag_record_bytes(header, std::string(kBagHeaderBytes - used, ' '));
  }

  void flush() {
    if (chunk_.size() == 0) return;
    const std::uint64_t chunk_at = position_;
    BagFields header;
    header.number<std::uint8_t>("op", 0x05).add("compression", "none");
    header.number("size", static_cast<std::uint32_t>(chunk_.size()));
    put(bag_record_bytes(header, chunk_.text()));
    ByteBuilder counts;
    for (const auto& [topic, entries] : index_) {
      put_index(topic, entries);
      counts.put(static_cast<std::uint32_t>(topic));
      counts.put(static_cast<std::uint32_t>(entries.size()));
    }
    BagFields info;
    info.number<std::uint8_t>("op", 0x06).number<std::uint32_t>("ver", 1);
    info.number("chunk_pos", chunk_at).number("start_time", ros1_time(chunk_start_));
    info.number("end_time", ros1_time(chunk_end_));
    info.number("count", static_cast<std::uint32_t>(index_.size()));
    chunk_infos_.push_back(bag_record_bytes(info, counts.text()));
    chunk_.clear();
    index_.clear();
  }

  void put_index(unsigned topic, const std::vector<IndexEntry>& entries) {
    BagFields header;
    header.number<std::uint8_t>("op", 0x04).number<std::uint32_t>("ver", 1);
    header.number<std::uint32_t>("conn", topic);
    header.number("count", static_cast<std::uint32_t>(entries.size()));
    ByteBuilder data;
    for (const IndexEntry& entry : entries) {
      data.put(ros1_time(entry.t_ns));
      data.put(entry.offset);
    }
    put(bag_record_bytes(header, data.text()));
  }

  void put(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) fail_to_write(target_.target(), errno);
    position_ += bytes.size();
  }

  AtomicFile target_;
  std::ofstream stream_;
  std::uint64_t position_ = 0;
  std::vector<std::string> connections_;  ///< their records
  std::vector<std::string> chunk_infos_;
  ByteBuilder chunk_;
  std::map<unsigned, std::vector<IndexEntry>> index_;  ///< of the chunk, by topic
  TimeNs chunk_start_ = 0;
  TimeNs chunk_end_ = 0;
};

}  // namespace

std::unique_ptr<MessageFileWriter> make_bag_writer(const std::filesystem::path& file) {
  return std::make_unique<BagFileWriter>(file);
}

}  // namespace saccade
