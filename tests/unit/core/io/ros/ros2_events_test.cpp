#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/io/events/event_formats.h"
#include "core/io/events/prophesee/evt3.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/ros/ros2_bytes.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::bytes_of;
using testing::Cdr;
using testing::error_of;
using testing::event_packet;
using ::testing::HasSubstr;
using testing::kMcapEnd;
using testing::kMcapHead;
using testing::kSensor;
using testing::mcap_channel;
using testing::mcap_chunk;
using testing::mcap_message;

const std::string kPacketType = "event_camera_msgs/msg/EventPacket";

/// Events in the words of the encoding mono, from `base_ns` on.
std::string mono_words(const Events& events, TimeNs base_ns) {
  std::string words;
  for (const Event& event : events)
    words += bytes_of(static_cast<std::uint32_t>(event.t_ns - base_ns), event.x,
                      static_cast<std::uint16_t>(event.y | (event.polarity > 0 ? 0x8000 : 0)));
  return words;
}

class Ros2Events : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path mcap(const std::string& records) const {
    return folder_.write("r.mcap", kMcapHead + records + kMcapEnd);
  }
  [[nodiscard]] Events packet(const std::string& encoding, TimeNs stamp_ns, std::uint64_t base,
                              const std::string& words) const {
    return read_events(mcap(mcap_channel(1, "/c/events", kPacketType) +
                            mcap_message(1, event_packet(stamp_ns, base, encoding, words))),
                       {});
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read_events(folder_.write("r.mcap", bytes), {}); });
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Ros2Events, ChunksOfMcapAreRead) {
  Events events = testing::random_events(3000, 1'500'000'000'000'000'000);
  sort_ties(events);
  const Events first(events.begin(), events.begin() + 1000);
  const Events second(events.begin() + 1000, events.end());
  const auto message = [](const Events& part) {
    return mcap_message(3, event_packet(part[0].t_ns, static_cast<std::uint64_t>(part[0].t_ns),
                                        "mono", mono_words(part, part[0].t_ns)));
  };
  const std::string other =
      mcap_channel(2, "/c/points", "foxglove.PointCloud", "protobuf") + mcap_message(2, "anything");
  for (const std::string compression : {"", "lz4", "zstd"}) {
    const fs::path file =
        mcap(mcap_chunk(compression,
                        other + mcap_channel(3, "/c/events", kPacketType) + message(first)) +
             mcap_chunk(compression, message(second)));
    EXPECT_EQ(recognise_event_format(file).name, "MCAP");
    EXPECT_EQ(read_events(file, {}), events) << compression;
    EXPECT_EQ(stated_sensor(file).height, kSensor.height);
  }
}

TEST_F(Ros2Events, ArraysOfRos2AreAligned) {
  const Events events = testing::random_events(7);
  Cdr array;
  array.header(5).number(std::uint32_t{180}).number(std::uint32_t{240}).number(std::uint32_t{7});
  for (const Event& event : events) {
    array.number(event.x).number(event.y).stamp(event.t_ns);
    array.number(static_cast<std::uint8_t>(event.polarity > 0 ? 1 : 0));
  }
  Events expected = events;
  sort_ties(expected);
  EXPECT_EQ(read_events(mcap(mcap_channel(1, "/e", "dvs_msgs/msg/EventArray") +
                             mcap_message(1, array.bytes())),
                        {}),
            expected);
}

TEST_F(Ros2Events, MonoCountsFromTheStampOfTheFirstPacket) {
  const Events events{{50, 3, 4, 1}, {70, 239, 179, -1}};
  EXPECT_EQ(packet("mono", 1'000'000, 40, mono_words(events, 40)),
            (Events{{1'000'000, 3, 4, 1}, {1'000'020, 239, 179, -1}}));
}

/// The words of libcaer_cmp: 0 upper time, 1 lower time [us], 2 column, 3 row, 4 first row, 5 mask.
TEST_F(Ros2Events, LibcaerCmpCountsMicrosecondsFromItsBase) {
  const std::string words = bytes_of(
      std::uint16_t{0x2005}, std::uint16_t{0x3807}, std::uint16_t{0x1003}, std::uint16_t{0x3008},
      std::uint16_t{0x0001}, std::uint16_t{0x1000}, std::uint16_t{0x2010}, std::uint16_t{0x4864},
      std::uint16_t{0x5081}, std::uint16_t{0x5001});
  constexpr TimeNs kBaseNs = 1'700'000'000'000'000'000;
  EXPECT_EQ(packet("libcaer_cmp", 9, kBaseNs / 1000, words),
            (Events{{kBaseNs, 5, 7, 1},
                    {kBaseNs + 3'000, 5, 8, -1},
                    {kBaseNs + 4'096'000, 16, 100, 1},
                    {kBaseNs + 4'096'000, 16, 107, 1},
                    {kBaseNs + 4'096'000, 16, 108, 1}}));
  EXPECT_THAT(
      error_of([&] { return packet("libcaer_cmp", 9, 0, bytes_of(std::uint16_t{0x7000})); }),
      HasSubstr("word 0 (7000) is of a type that libcaer_cmp does not have"));
}

TEST_F(Ros2Events, LibcaerTimesMayWrapWithinAPacket) {
  const auto word = [](unsigned x, unsigned y, bool on, std::uint32_t t_us) {
    return bytes_of(1U | (on ? 2U : 0U) | y << 2U | x << 17U, t_us);
  };
  constexpr TimeNs kBase = 1'700'000'000'000'000'000;
  EXPECT_EQ(packet("libcaer", 9, kBase, word(5, 6, true, 0x7FFFFFFF) + word(239, 179, false, 1)),
            (Events{{kBase + 0x7FFFFFFFLL * 1000, 5, 6, 1},
                    {kBase + 0x80000001LL * 1000, 239, 179, -1}}));
}

TEST_F(Ros2Events, Evt3GoesOnFromPacketToPacketAndMovesToTheStamp) {
  Events events = testing::random_events(2000, 0, 5000);
  for (Event& event : events) event.t_ns -= event.t_ns % 1000;
  sort_ties(events);
  const fs::path raw = folder_.path() / "r.raw";
  const auto writer = make_evt3_writer(raw, {}, kSensor);
  writer->append(events);
  writer->close();
  const std::string bytes = testing::read_file(raw);
  const std::string words = bytes.substr(bytes.find("% end\n") + 6);
  const std::size_t half = words.size() / 4 * 2;
  constexpr TimeNs kStamp = 1'600'000'000'000'000'000;
  const Events read =
      read_events(mcap(mcap_channel(1, "/c/events", kPacketType) +
                       mcap_message(1, event_packet(kStamp, 0, "evt3", words.substr(0, half))) +
                       mcap_message(1, event_packet(kStamp + 5, 0, "evt3", words.substr(half)))),
                  {});
  const TimeNs shift_ns = kStamp - events.front().t_ns;
  for (Event& event : events) event.t_ns += shift_ns;
  EXPECT_EQ(read, events);
}

TEST_F(Ros2Events, FilesOfRosbag2AreRead) {
  Events events = testing::random_events(300, 1'500'000'000'000'000'000);
  sort_ties(events);
  const auto message = [](const Events& part) {
    return event_packet(part[0].t_ns, static_cast<std::uint64_t>(part[0].t_ns), "mono",
                        mono_words(part, part[0].t_ns));
  };
  const Events first(events.begin(), events.begin() + 100);
  const Events second(events.begin() + 100, events.end());
  const fs::path file = folder_.path() / "a?b#.db3";
  testing::write_rosbag2(file, {{"/imu", "sensor_msgs/msg/Imu"}, {"/c/events", kPacketType}},
                         {{2, message(first)}, {1, "any"}, {2, message(second)}});
  EXPECT_EQ(recognise_event_format(file).name, "rosbag2");
  EXPECT_EQ(read_events(file, {}), events);

  // Messages may be compressed one by one.
  const fs::path packed = folder_.path() / "packed.db3";
  testing::write_rosbag2(
      packed, {{"/c/events", kPacketType}},
      {{1, testing::zstd_frame(message(first))}, {1, testing::zstd_frame(message(second))}});
  EXPECT_EQ(read_events(packed, {}), events);

  // As a folder of two files.
  fs::create_directories(folder_.path() / "bag");
  testing::write_rosbag2(folder_.path() / "bag/bag_0.db3", {{"/c/events", kPacketType}},
                         {{1, message(first)}});
  testing::write_rosbag2(folder_.path() / "bag/bag_1.db3", {{"/c/events", kPacketType}},
                         {{1, message(second)}});
  folder_.write("bag/metadata.yaml",
                "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                "  relative_file_paths:\n    - bag_0.db3\n    - bag_1.db3\n"
                "  compression_format: \"\"\n  compression_mode: \"\"\n");
  EXPECT_EQ(read_events(folder_.path() / "bag", {}), events);
  EXPECT_EQ(read_events((folder_.path() / "bag").string() + "!/c/events", {}), events);
}

TEST_F(Ros2Events, NamesTheMessageOfARosbag2) {
  const fs::path file = folder_.path() / "r.db3";
  const auto problem = [&](const std::vector<testing::Rosbag2Message>& messages) {
    testing::write_rosbag2(file, {{"/c/events", kPacketType}}, messages);
    return error_of([&] { return read_events(file, {}); });
  };
  const std::string good = event_packet(0, 0, "mono", mono_words({{0, 1, 1, 1}}, 0));
  EXPECT_THAT(problem({{1, good}, {1, "short"}}),
              HasSubstr("r.db3:message 2: in a message of /c/events: its CDR has"));
  EXPECT_THAT(problem({{1, good}, {2, good}}),
              HasSubstr("r.db3:message 2: it belongs to no topic"));
  EXPECT_THAT(problem({{1, good.substr(0, good.size() - 1)}}), HasSubstr("it ends too early"));
  EXPECT_THAT(problem({{1, event_packet(0, 0, "trigger", "")}}),
              HasSubstr("the encoding 'trigger' cannot be read"));
  EXPECT_THAT(problem({{1, event_packet(0, 0, "mono", mono_words({{0, 240, 1, 1}}, 0))}}),
              HasSubstr("event 0: pixel (240, 1) lies outside the sensor of 240 x 180 px"));
  const std::string bytes = testing::read_file(file);
  EXPECT_THAT(
      error_of([&] { return read_events(folder_.write("t.db3", bytes.substr(0, 5000)), {}); }),
      HasSubstr("is no rosbag2 that can be read"));
}

TEST_F(Ros2Events, NamesTheByteOfAnMcap) {
  const std::string at = "r.mcap:byte " + std::to_string(kMcapHead.size()) + ": ";
  const std::string channel = mcap_channel(1, "/c/events", kPacketType);
  const std::string good =
      mcap_message(1, event_packet(0, 0, "mono", mono_words({{0, 1, 1, 1}}, 0)));
  std::string chunk = mcap_chunk("", channel + good);
  EXPECT_THAT(error(kMcapHead + chunk), HasSubstr("ends without the record that closes it"));
  chunk[chunk.size() - 3] ^= 1;
  EXPECT_THAT(error(kMcapHead + chunk + kMcapEnd), HasSubstr(at + "the checksum of the chunk is"));
  EXPECT_THAT(error(kMcapHead + mcap_chunk("zip", "") + kMcapEnd),
              HasSubstr(at + "the chunk is compressed by 'zip'"));
  EXPECT_THAT(error(kMcapHead + good + kMcapEnd),
              HasSubstr(at + "a message of the unknown channel"));
  EXPECT_THAT(error(kMcapHead + mcap_channel(1, "/c/events", kPacketType, "json") +
                    mcap_message(1, "{}") + kMcapEnd),
              HasSubstr("serialised neither by ROS 1 nor in the CDR"));
  EXPECT_THAT(error(kMcapHead + testing::mcap_record(0x06, "") + kMcapEnd),
              HasSubstr(at + "a record ends too early"));
  EXPECT_THAT(error(kMcapHead + bytes_of(std::uint8_t{5}, std::uint64_t{1} << 60U)),
              HasSubstr("ends within a record"));
}

TEST_F(Ros2Events, DamagedFilesAreReportedOrRead) {
  const std::string records =
      mcap_channel(1, "/c/events", kPacketType) +
      mcap_message(1, event_packet(0, 0, "mono", mono_words(testing::random_events(5), 0)));
  for (const std::string compression : {"", "lz4", "zstd"}) {
    const std::string file = kMcapHead + mcap_chunk(compression, records) + kMcapEnd;
    // Behind the record that ends the data nothing is read.
    const std::size_t used = file.size() - kMcapEnd.size() + 13;
    testing::expect_damage_is_reported(file.substr(0, used), used, [&](const std::string& bytes) {
      return read_events(folder_.write("r.mcap", bytes.size() < 8 ? std::string(1, '\0') : bytes),
                         {});
    });
  }
}

}  // namespace
}  // namespace saccade
