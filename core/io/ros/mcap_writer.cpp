#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/io/files/atomic_file.h"
#include "core/io/files/byte_builder.h"
#include "core/io/files/compression.h"
#include "core/io/ros/mcap_file.h"
#include "core/io/ros/message_types.h"
#include "core/io/ros/message_writer.h"

namespace saccade {
namespace {

constexpr std::size_t kMcapChunkBytes = std::size_t{1} << 20U;

std::string mcap_record(McapOp op, const ByteBuilder& content) {
  ByteBuilder record;
  record.put(op);
  record.put(static_cast<std::uint64_t>(content.size()));
  record.put_text(content.text());
  return std::string(record.text());
}

std::uint32_t checksum_of(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

class McapFileWriter final : public MessageFileWriter {
 public:
  explicit McapFileWriter(const std::filesystem::path& file)
      : target_(file), stream_(target_.path(), std::ios::binary) {
    put(kMcapMagic);
    ByteBuilder header;
    header.put_sized("ros2");
    header.put_sized("saccade");
    put(mcap_record(McapOp::kHeader, header));
  }

  unsigned add_topic(std::string_view name, std::string_view type) override {
    const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
    auto schema = schema_ids_.find(type);
    if (schema == schema_ids_.end()) {
      const auto id = static_cast<std::uint16_t>(schema_ids_.size() + 1);
      schema = schema_ids_.emplace(std::string(type), id).first;
      ByteBuilder content;
      content.put(id);
      content.put_sized(ros2_type_name(type));
      content.put_sized("ros2msg");
      content.put_sized(ros2_definition(type));
      schemas_.push_back(mcap_record(McapOp::kSchema, content));
      chunk_.put_text(schemas_.back());
    }
    ByteBuilder content;
    content.put(number);
    content.put(schema->second);
    content.put_sized(name);
    content.put_sized("cdr");
    content.put(std::uint32_t{0});  // no metadata
    channels_.push_back(mcap_record(McapOp::kChannel, content));
    chunk_.put_text(channels_.back());
    counts_[number] = 0;
    return number;
  }

  void write(unsigned topic, TimeNs t_ns, std::span<const std::byte> bytes) override {
    const auto number = static_cast<std::uint16_t>(topic);
    const auto time = static_cast<std::uint64_t>(t_ns);
    if (index_.empty()) chunk_start_ = chunk_end_ = time;
    chunk_start_ = std::min(chunk_start_, time);
    chunk_end_ = std::max(chunk_end_, time);
    index_[number].push_back({time, chunk_.size()});
    ByteBuilder head;
    head.put(number);
    head.put(static_cast<std::uint32_t>(counts_[number]++));
    head.put(time);
    head.put(time);
    chunk_.put(McapOp::kMessage);
    chunk_.put(static_cast<std::uint64_t>(head.size() + bytes.size()));
    chunk_.put_text(head.text());
    chunk_.put_bytes(bytes);
    if (chunk_.size() >= kMcapChunkBytes) flush();
  }

  void close() override {
    flush();
    ByteBuilder end;
    end.put(std::uint32_t{0});  // no checksum of all data: chunks have theirs
    put(mcap_record(McapOp::kDataEnd, end));
    put_summary();
    put(kMcapMagic);
    stream_.close();
    if (!stream_) fail_to_write(target_.target(), errno);
    target_.commit();
  }

  [[nodiscard]] Serialisation serialisation() const override { return Serialisation::kCdr; }

 private:
  struct IndexEntry {
    std::uint64_t time;
    std::uint64_t offset;
  };

  void flush() {
    if (chunk_.size() == 0) return;
    const std::vector<std::byte> packed = pack_lz4(chunk_.bytes());
    const std::uint64_t chunk_at = position_;
    ByteBuilder content;
    content.put(chunk_start_);
    content.put(chunk_end_);
    content.put(static_cast<std::uint64_t>(chunk_.size()));
    content.put(checksum_of(chunk_.text()));
    content.put_sized("lz4");
    content.put(static_cast<std::uint64_t>(packed.size()));
    content.put_bytes(packed);
    put(mcap_record(McapOp::kChunk, content));
    const std::uint64_t chunk_bytes = position_ - chunk_at;
    ByteBuilder offsets;
    const std::uint64_t index_at = position_;
    for (const auto& [channel, entries] : index_) {
      offsets.put(channel);
      offsets.put(position_);
      put_index(channel, entries);
    }
    ByteBuilder summary;
    summary.put(chunk_start_);
    summary.put(chunk_end_);
    summary.put(chunk_at);
    summary.put(chunk_bytes);
    summary.put_sized(offsets.text());
    summary.put(position_ - index_at);
    summary.put_sized("lz4");
    summary.put(static_cast<std::uint64_t>(packed.size()));
    summary.put(static_cast<std::uint64_t>(chunk_.size()));
    chunk_indices_.push_back(mcap_record(McapOp::kChunkIndex, summary));
    if (!index_.empty()) {
      start_ = chunk_indices_.size() == 1 ? chunk_start_ : std::min(start_, chunk_start_);
      end_ = std::max(end_, chunk_end_);
    }
    chunk_.clear();
    index_.clear();
    chunk_start_ = chunk_end_ = 0;
  }

  void put_index(std::uint16_t channel, const std::vector<IndexEntry>& entries) {
    ByteBuilder list;
    for (const IndexEntry& entry : entries) {
      list.put(entry.time);
      list.put(entry.offset);
    }
    ByteBuilder content;
    content.put(channel);
    content.put_sized(list.text());
    put(mcap_record(McapOp::kMessageIndex, content));
  }

  [[nodiscard]] std::string statistics() const {
    std::uint64_t messages = 0;
    ByteBuilder by_channel;
    for (const auto& [channel, count] : counts_) {
      messages += count;
      by_channel.put(channel);
      by_channel.put(count);
    }
    ByteBuilder content;
    content.put(messages);
    content.put(static_cast<std::uint16_t>(schemas_.size()));
    content.put(static_cast<std::uint32_t>(channels_.size()));
    content.put(std::uint32_t{0});  // attachments
    content.put(std::uint32_t{0});  // metadata
    content.put(static_cast<std::uint32_t>(chunk_indices_.size()));
    content.put(start_);
    content.put(end_);
    content.put_sized(by_channel.text());
    return mcap_record(McapOp::kStatistics, content);
  }

  /// Groups of records, where each begins, and the footer with the checksum of all that.
  void put_summary() {
    const std::uint64_t summary_at = position_;
    std::string summary;
    ByteBuilder places;
    const auto add_group = [&](McapOp op, const std::vector<std::string>& records) {
      if (records.empty()) return;
      const std::uint64_t begin = summary_at + summary.size();
      for (const std::string& record : records) summary += record;
      ByteBuilder place;
      place.put(op);
      place.put(begin);
      place.put(summary_at + summary.size() - begin);
      places.put_text(mcap_record(McapOp::kSummaryOffset, place));
    };
    add_group(McapOp::kSchema, schemas_);
    add_group(McapOp::kChannel, channels_);
    add_group(McapOp::kStatistics, {statistics()});
    add_group(McapOp::kChunkIndex, chunk_indices_);
    const std::uint64_t places_at = summary_at + summary.size();
    summary += places.text();
    ByteBuilder footer;
    footer.put(McapOp::kFooter);
    footer.put(std::uint64_t{20});
    footer.put(summary_at);
    footer.put(places_at);
    footer.put(checksum_of(footer.text(), checksum_of(summary)));
    put(summary);
    put(footer.text());
  }

  void put(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) fail_to_write(target_.target(), errno);
    position_ += bytes.size();
  }

  AtomicFile target_;
  std::ofstream stream_;
  std::uint64_t position_ = 0;
  std::map<std::string, std::uint16_t, std::less<>> schema_ids_;
  std::vector<std::string> schemas_, channels_, chunk_indices_;  ///< their records
  std::map<std::uint16_t, std::uint64_t> counts_;                ///< messages of each channel
  ByteBuilder chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;               ///< of the chunk
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0, start_ = 0, end_ = 0;  ///< [ns]
};

}  // namespace

std::unique_ptr<MessageFileWriter> make_mcap_writer(const std::filesystem::path& file) {
  return std::make_unique<McapFileWriter>(file);
}

bool is_written_recording(const std::filesystem::path& file) {
  return file.extension() == ".bag" || file.extension() == ".mcap";
}

std::unique_ptr<MessageFileWriter> make_message_writer(const std::filesystem::path& file) {
  return file.extension() == ".bag" ? make_bag_writer(file) : make_mcap_writer(file);
}

}  // namespace saccade
