#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/files/compression.h"
#include "core/io/ros/bag_file.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

template <class... Numbers>
std::string bytes_of(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

std::string sized(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size())) + text;
}

using Fields = std::vector<std::pair<std::string, std::string>>;

std::string fields_text(const Fields& fields) {
  std::string text;
  for (const auto& [name, value] : fields) text += sized(name + "=" + value);
  return text;
}

std::string record(const Fields& header, const std::string& data) {
  return sized(fields_text(header)) + sized(data);
}

std::string connection(std::uint32_t number, const std::string& topic, const std::string& type) {
  return record({{"op", "\x07"}, {"conn", bytes_of(number)}, {"topic", topic}},
                fields_text({{"topic", topic}, {"type", type}, {"md5sum", "*"}}));
}

std::string event_array(std::span<const Event> events) {
  std::string data = bytes_of(std::uint32_t{0}, std::uint32_t{1}, std::uint32_t{2}) +
                     sized("camera") +
                     bytes_of(static_cast<std::uint32_t>(testing::kSensor.height),
                              static_cast<std::uint32_t>(testing::kSensor.width),
                              static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events)
    data += bytes_of(event.x, event.y, static_cast<std::uint32_t>(event.t_ns / 1'000'000'000),
                     static_cast<std::uint32_t>(event.t_ns % 1'000'000'000),
                     static_cast<std::uint8_t>(event.polarity > 0 ? 1 : 0));
  return data;
}

std::string message(std::uint32_t number, const std::string& data) {
  return record({{"op", "\x02"}, {"conn", bytes_of(number)}, {"time", bytes_of(std::uint64_t{0})}},
                data);
}

std::string chunk(const std::string& compression, const std::string& records) {
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
  return record({{"op", "\x05"},
                 {"compression", compression},
                 {"size", bytes_of(static_cast<std::uint32_t>(records.size()))}},
                packed);
}

const std::string kHead =
    std::string(kBagMagic) + record({{"op", "\x03"},
                                     {"index_pos", bytes_of(std::uint64_t{0})},
                                     {"conn_count", bytes_of(std::uint32_t{1})},
                                     {"chunk_count", bytes_of(std::uint32_t{1})}},
                                    std::string(100, ' '));

class BagEvents : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path write(const std::string& bytes) const {
    return folder_.write("r.bag", bytes);
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read_events(write(bytes), {}); });
  }

  testing::TemporaryFolder folder_;
  std::string events_ = connection(4, "/dvs/events", "dvs_msgs/EventArray");
};

TEST_F(BagEvents, ChunksOfEveryCompressionAreRead) {
  Events events = testing::random_events(3000, 1'500'000'000'000'000'000);
  sort_ties(events);
  const std::span<const Event> all(events);
  const std::string imu = connection(5, "/dvs/imu", "sensor_msgs/Imu");
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    const std::string bag = kHead +
                            chunk(compression, imu + events_ + message(5, "any") +
                                                   message(4, event_array(all.first(1000)))) +
                            record({{"op", "\x04"}, {"ver", "1"}}, "an index") +
                            chunk(compression, message(4, event_array({})) +
                                                   message(4, event_array(all.subspan(1000)))) +
                            events_ + record({{"op", "\x06"}}, "the place of a chunk");
    const fs::path file = write(bag);
    EXPECT_EQ(recognise_event_format(file).name, "ROS bag");
    EXPECT_EQ(read_events(file, {}), events) << compression;
    EXPECT_EQ(stated_sensor(file).width, testing::kSensor.width);
    const TimeWindow window{events[1500].t_ns, events[2000].t_ns};
    for (const Event& event : read_events(file, {}, window)) {
      ASSERT_GE(event.t_ns, window.start_ns);
      ASSERT_LT(event.t_ns, window.end_ns);
    }
  }
}

TEST_F(BagEvents, OneOfSeveralTopicsIsNamed) {
  const Events left = testing::random_events(10);
  const Events right = testing::random_events(20);
  const fs::path file = write(
      kHead + chunk("none", connection(0, "/left/events", "dvs_msgs/EventArray") +
                                connection(1, "/right/events", "dvs_msgs/EventArray") +
                                message(0, event_array(left)) + message(1, event_array(right))));
  EXPECT_EQ(read_events(file.string() + "!/left/events", {}).size(), 10U);
  EXPECT_EQ(read_events(file.string() + "!/right/events", {}).size(), 20U);
  EXPECT_EQ(read_event_file_info(file.string() + "!/right/events").count, 20U);
  EXPECT_THAT(error_of([&] { return read_events(file, {}); }),
              HasSubstr("several topics, /left/events and /right/events; name one, as in"));
  EXPECT_THAT(
      error_of([&] { return read_events(file.string() + "!/up/events", {}); }),
      HasSubstr("no events of the topic /up/events; its topics are /left/events (dvs_msgs"));
}

TEST_F(BagEvents, NamesTheByteOfWhatIsWrong) {
  const Events events = testing::random_events(10);
  const std::string at = "r.bag:byte " + std::to_string(kHead.size()) + ": ";
  const std::string good = kHead + chunk("none", events_ + message(4, event_array(events)));
  EXPECT_THAT(error(good.substr(0, good.size() - 1)), HasSubstr("the file ends within the data"));
  EXPECT_THAT(error(kHead + chunk("zip", "")), HasSubstr(at + "the chunk is compressed by 'zip'"));
  EXPECT_THAT(error(kHead + chunk("none", message(3, ""))),
              HasSubstr(at + "a message of the unknown connection 3"));
  EXPECT_THAT(
      error(kHead + chunk("none", events_ + message(4, "short"))),
      HasSubstr(at + "in a message of /dvs/events in the record that begins here: it ends"));
  EXPECT_THAT(
      error(kHead + chunk("none", events_ + message(4, event_array(Events{{0, 240, 0, 1}})))),
      HasSubstr("event 0: pixel (240, 0) lies outside the sensor of 240 x 180 px"));
  EXPECT_THAT(
      error(kHead +
            chunk("none", events_ + message(4, event_array(Events{{5, 0, 0, 1}, {4, 0, 0, 1}})))),
      HasSubstr("event 1: time goes back"));
  EXPECT_THAT(error(kHead), HasSubstr("holds no events; it has no topics"));
  EXPECT_THAT(error(kHead + "\xFF\xFF\xFF\x7F"), HasSubstr("ends within the header of a record"));
}

TEST_F(BagEvents, DamagedFilesAreReportedOrRead) {
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    const std::string bag =
        kHead + chunk(compression, events_ + message(4, event_array(testing::random_events(5))));
    testing::expect_damage_is_reported(bag, bag.size(), [&](const std::string& bytes) {
      return read_events(write(bytes.size() < kBagMagic.size() ? std::string(1, '\0') : bytes), {});
    });
  }
}

}  // namespace
}  // namespace saccade
