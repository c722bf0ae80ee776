#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/io/events/aedat/aedat4.h"
#include "core/io/events/aedat/aedat4_event.h"
#include "core/io/events/aedat/aedat4_file.h"
#include "core/io/events/rounded_events.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/byte_builder.h"

namespace saccade {
namespace {

constexpr std::size_t kPacketEvents = std::size_t{1} << 14U;

/// "<attr key="KEY" type="TYPE">VALUE</attr>".
std::string xml_attribute(std::string_view key, std::string_view type, std::string_view value) {
  return fmt::format("<attr key=\"{}\" type=\"{}\">{}</attr>\n", key, type, value);
}

/// One stream of events, number 0.
std::string describe_streams(SensorSize sensor) {
  constexpr std::string_view kPath = "/mainloop/Recorder/outInfo/";
  std::string info = xml_attribute("source", "string", "saccade");
  if (sensor.width > 0)
    info += xml_attribute("sizeX", "int", std::to_string(sensor.width)) +
            xml_attribute("sizeY", "int", std::to_string(sensor.height));
  info += xml_attribute("tsOffset", "long", "0");
  return fmt::format(
      "<dv version=\"2.0\">\n<node name=\"outInfo\" path=\"{0}\">\n<node name=\"0\" "
      "path=\"{0}0/\">\n{1}<node name=\"info\" path=\"{0}0/info/\">\n{2}</node>\n</node>\n</node>\n"
      "</dv>\n",
      kPath,
      xml_attribute("compression", "string", "LZ4") +
          xml_attribute("originalModuleName", "string", "saccade") +
          xml_attribute("originalOutputName", "string", "events") +
          xml_attribute("typeDescription", "string", "Array of events (polarity ON/OFF).") +
          xml_attribute("typeIdentifier", "string", "EVTS"),
      info);
}

/// A table whose fields lie behind one another: its size, root and identifier, the places of the
/// fields, and the table's own beginning, which points back to them.
void put_table_head(std::uint32_t size, std::string_view identifier,
                    std::initializer_list<std::uint16_t> places, std::uint16_t table_bytes,
                    ByteBuilder& builder) {
  const auto list_bytes = static_cast<std::uint16_t>(4 + 2 * places.size());
  const std::uint32_t list = 8U + (list_bytes % 4U);  // so that the table is aligned to 4 bytes
  builder.put(size);
  builder.put(list + list_bytes);  // of the table, from behind the size
  builder.put_text(identifier);
  for (std::uint32_t i = 8; i < list; ++i) builder.put(std::byte{0});
  builder.put(list_bytes);
  builder.put(table_bytes);
  for (const std::uint16_t place : places) builder.put(place);
  builder.put(static_cast<std::int32_t>(list_bytes));
}

/// Compression, place of the table of packets (-1: there is none) and description.
ByteBuilder header(SensorSize sensor) {
  constexpr std::int32_t kLz4 = 1;
  const std::string xml = describe_streams(sensor);
  ByteBuilder builder;
  // 8 of root and identifier, 12 of places with 2 of padding, and the table: 4 + 8 + 4 + 4.
  constexpr std::uint32_t kHeadBytes = 8 + 12 + 20;
  put_table_head(kHeadBytes + 4 + static_cast<std::uint32_t>(xml.size()) + 1, "IOHE", {12, 4, 16},
                 20, builder);
  builder.put(std::int64_t{-1});
  builder.put(kLz4);
  builder.put(std::uint32_t{4});  // from here to the text
  builder.put(static_cast<std::uint32_t>(xml.size()));
  builder.put_text(xml);
  builder.put('\0');
  return builder;
}

/// A packet's table of events.
ByteBuilder packet(std::span<const Event> events) {
  ByteBuilder builder;
  // 8 of root and identifier, 6 of places with 2 of padding, the table: 4 + 4, and the vector's
  // length, behind which the events are aligned to 8 bytes.
  constexpr std::uint32_t kHeadBytes = 8 + 8 + 8 + 4;
  const auto bytes = static_cast<std::uint32_t>(events.size() * kAedat4EventBytes);
  put_table_head(kHeadBytes + bytes, "EVTS", {4}, 8, builder);
  builder.put(std::uint32_t{4});  // from here to the vector
  builder.put(static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    builder.put(std::int64_t{event.t_ns / 1000});
    builder.put(event.x);
    builder.put(event.y);
    builder.put(std::uint32_t{event.polarity > 0 ? 1U : 0U});
  }
  return builder;
}

class Aedat4Writer final : public EventWriter {
 public:
  Aedat4Writer(const std::filesystem::path& file, SensorSize sensor)
      : target_(file), stream_(target_.path(), std::ios::binary) {
    stream_ << kAedat4Magic;
    write(header(sensor).bytes());
  }

  void append(std::span<const Event> events) override {
    while (!events.empty()) {
      const std::span<const Event> part = events.first(std::min(events.size(), kPacketEvents));
      events = events.subspan(part.size());
      events_.add(part);
      while (events_.complete().size() >= kPacketEvents) write_packet(kPacketEvents);
    }
  }

  void close() override {
    events_.finish();
    while (!events_.complete().empty())
      write_packet(std::min(kPacketEvents, events_.complete().size()));
    stream_.close();
    if (!stream_) fail_to_write(target_.target(), errno);
    target_.commit();
  }

  [[nodiscard]] std::uint64_t count() const override { return written_ + events_.size(); }

 private:
  void write_packet(std::size_t count) {
    const std::span<const Event> events = events_.complete().first(count);
    for (const Event& event : events)
      if (event.x > kMostCoordinate || event.y > kMostCoordinate)
        throw InputError(target_.target().string(),
                         fmt::format("AEDAT4 holds coordinates up to {}; there is an event at "
                                     "({}, {})",
                                     kMostCoordinate, event.x, event.y));
    const std::vector<std::byte> packed = pack_lz4(packet(events).bytes());
    ByteBuilder head;
    head.put(std::int32_t{0});  // the stream
    head.put(static_cast<std::int32_t>(packed.size()));
    write(head.bytes());
    write(packed);
    written_ += count;
    events_.drop(count);
  }

  void write(std::span<const std::byte> bytes) {
    stream_.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
    if (!stream_) fail_to_write(target_.target(), errno);
  }

  static constexpr int kMostCoordinate = std::numeric_limits<std::int16_t>::max();

  AtomicFile target_;
  std::ofstream stream_;
  RoundedEvents events_{TimestampUnit::kMicroseconds};
  std::uint64_t written_ = 0;
};

}  // namespace

std::unique_ptr<EventWriter> make_aedat4_writer(const std::filesystem::path& file,
                                                TimestampUnit /*unit*/, SensorSize sensor) {
  return std::make_unique<Aedat4Writer>(file, sensor);
}

}  // namespace saccade
