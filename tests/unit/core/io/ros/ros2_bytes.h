#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/files/compression.h"
#include "tests/unit/core/io/ros/bag_bytes.h"

/// The parts of recordings of ROS 2, put together after their descriptions.
namespace saccade::testing {

/// The Common Data Representation: numbers at multiples of their size from behind the first 4 bytes.
class Cdr {
 public:
  template <class T>
  Cdr& number(T value) {
    bytes_.resize(4 + (bytes_.size() - 4 + sizeof(T) - 1) / sizeof(T) * sizeof(T), '\0');
    bytes_ += bytes_of(value);
    return *this;
  }
  Cdr& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value + '\0';
    return *this;
  }
  Cdr& stamp(TimeNs t_ns) {
    number(static_cast<std::int32_t>(t_ns / 1'000'000'000));
    return number(static_cast<std::uint32_t>(t_ns % 1'000'000'000));
  }
  Cdr& header(TimeNs t_ns) { return stamp(t_ns).text("camera"); }
  Cdr& array(const std::string& data) {
    number(static_cast<std::uint32_t>(data.size()));
    bytes_ += data;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_ = std::string("\x00\x01\x00\x00", 4);
};

inline std::string event_packet(TimeNs stamp_ns, std::uint64_t time_base,
                                const std::string& encoding, const std::string& events) {
  return Cdr()
      .header(stamp_ns)
      .number(static_cast<std::uint32_t>(kSensor.height))
      .number(static_cast<std::uint32_t>(kSensor.width))
      .number(std::uint64_t{7})
      .number(time_base)
      .text(encoding)
      .number(std::uint8_t{0})
      .array(events)
      .bytes();
}

inline std::string mcap_record(std::uint8_t op, const std::string& content) {
  return bytes_of(op, static_cast<std::uint64_t>(content.size())) + content;
}

inline std::string mcap_channel(std::uint16_t number, const std::string& topic,
                                const std::string& type, const std::string& encoding = "cdr") {
  return mcap_record(0x03, bytes_of(number) + sized(type) + sized("ros2msg") + sized("")) +
         mcap_record(0x04, bytes_of(number, number) + sized(topic) + sized(encoding) +
                               bytes_of(std::uint32_t{0}));
}

inline std::string mcap_message(std::uint16_t channel, const std::string& data) {
  return mcap_record(
      0x05, bytes_of(channel, std::uint32_t{0}, std::uint64_t{0}, std::uint64_t{0}) + data);
}

inline std::string zstd_frame(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

inline std::string mcap_chunk(const std::string& compression, const std::string& records) {
  std::string packed = records;
  if (compression == "lz4") {
    const auto bytes = pack_lz4(std::as_bytes(std::span(records)));
    packed.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  if (compression == "zstd") packed = zstd_frame(records);
  const auto checksum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(records.data()), static_cast<uInt>(records.size())));
  return mcap_record(0x06, bytes_of(std::uint64_t{0}, std::uint64_t{0},
                                    static_cast<std::uint64_t>(records.size()), checksum) +
                               sized(compression) +
                               bytes_of(static_cast<std::uint64_t>(packed.size())) + packed);
}

inline const std::string kMcapHead =
    "\x89MCAP0\r\n" + mcap_record(0x01, sized("ros2") + sized("a test"));
inline const std::string kMcapEnd =
    mcap_record(0x0F, bytes_of(std::uint32_t{0})) +
    mcap_record(0x02, bytes_of(std::uint64_t{0}, std::uint64_t{0}, std::uint32_t{0})) +
    "\x89MCAP0\r\n";

struct Rosbag2Message {
  int topic;
  std::string data;
};

/// A SQLite file of rosbag2; the first topic has the number 1.
inline void write_rosbag2(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& topics,
                          const std::vector<Rosbag2Message>& messages) {
  std::filesystem::remove(file);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  const auto run = [&](const std::string& sql) {
    ASSERT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sql;
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER "
      "NOT NULL, data BLOB NOT NULL)");
  for (const auto& [name, type] : topics)
    run("INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES('" +
        name + "', '" + type + "', 'cdr', '')");
  for (std::size_t i = 0; i < messages.size(); ++i) {
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                       -1, &insert, nullptr);
    sqlite3_bind_int(insert, 1, messages[i].topic);
    sqlite3_bind_int64(insert, 2, static_cast<std::int64_t>(i));
    sqlite3_bind_blob(insert, 3, messages[i].data.data(), static_cast<int>(messages[i].data.size()),
                      SQLITE_STATIC);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  sqlite3_close(database);
}

}  // namespace saccade::testing
