#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/io/files/compression.h"
#include "core/io/ros/bag_file.h"
#include "tests/unit/core/io/events/random_events.h"

/// The parts of bags of ROS 1, put together after its description.
namespace saccade::testing {

template <class... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

inline std::string sized(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}

using Fields = std::vector<std::pair<std::string, std::string>>;

inline std::string fields_text(const Fields& fields) {
  std::string text;
  for (const auto& [name, value] : fields) text += sized(name + "=" + value);
  return text;
}

inline std::string bag_record(const Fields& header, const std::string& data) {
  return sized(fields_text(header)) + sized(data);
}

inline std::string bag_connection(std::uint32_t number, const std::string& topic,
                                  const std::string& type) {
  return bag_record({{"op", "\x07"}, {"conn", bytes_of(number)}, {"topic", topic}},
                    fields_text({{"topic", topic}, {"type", type}, {"md5sum", "*"}}));
}

inline std::string event_array(std::span<const Event> events) {
  std::string data = bytes_of(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2}) +
                     sized("camera") +
                     bytes_of(static_cast<std::uint32_t>(kSensor.height),
                              static_cast<std::uint32_t>(kSensor.width),
                              static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events)
    data += bytes_of(event.x, event.y, static_cast<std::uint32_t>(event.t_ns / 1'000'000'000),
                     static_cast<std::uint32_t>(event.t_ns % 1'000'000'000),
                     static_cast<std::uint8_t>(event.polarity > 0 ? 1 : 0));
  return data;
}

inline std::string bag_message(std::uint32_t number, const std::string& data) {
  return bag_record(
      {{"op", "\x02"}, {"conn", bytes_of(number)}, {"time", bytes_of(std::uint64_t{0})}}, data);
}

inline std::string bag_chunk(const std::string& compression, const std::string& records) {
  std::string packed = records;
  if (compression == "lz4") {
    const auto bytes = pack_lz4(std::as_bytes(std::span(records)));
    packed.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  } else if (compression == "bz2") {
    auto size = static_cast<unsigned>(records.size() + records.size() / 100 + 600);
    packed.resize(size);
    std::string input = records;
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, input.data(),
                                       static_cast<unsigned>(input.size()), 9, 0, 0),
              BZ_OK);
    packed.resize(size);
  }
  return bag_record({{"op", "\x05"},
                     {"compression", compression},
                     {"size", bytes_of(static_cast<std::uint32_t>(records.size()))}},
                    packed);
}

inline const std::string kBagHead =
    std::string(kBagMagic) + bag_record({{"op", "\x03"},
                                         {"index_pos", bytes_of(std::uint64_t{0})},
                                         {"conn_count", bytes_of(std::uint32_t{1})},
                                         {"chunk_count", bytes_of(std::uint32_t{1})}},
                                        std::string(100, ' '));

}  // namespace saccade::testing
