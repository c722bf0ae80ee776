#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/ros/bag_file.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"
#include "tests/unit/core/io/ros/bag_bytes.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

using testing::bag_chunk;
using testing::bag_connection;
using testing::bag_message;
using testing::bag_record;
using testing::bytes_of;
using testing::event_array;
using testing::kBagHead;

class BagEvents : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path write(const std::string& bytes) const {
    return folder_.write("r.bag", bytes);
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read_events(write(bytes), {}); });
  }

  testing::TemporaryFolder folder_;
  std::string events_ = bag_connection(4, "/dvs/events", "dvs_msgs/EventArray");
};

TEST_F(BagEvents, ChunksOfEveryCompressionAreRead) {
  Events events = testing::random_events(3000, 1'500'000'000'000'000'000);
  sort_ties(events);
  const std::span<const Event> all(events);
  const std::string imu = bag_connection(5, "/dvs/imu", "sensor_msgs/Imu");
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    const std::string bag =
        kBagHead +
        bag_chunk(compression, imu + events_ + bag_message(5, "any") +
                                   bag_message(4, event_array(all.first(1000)))) +
        bag_record({{"op", "\x04"}, {"ver", "1"}}, "an index") +
        bag_chunk(compression, bag_message(4, event_array({})) +
                                   bag_message(4, event_array(all.subspan(1000)))) +
        events_ + bag_record({{"op", "\x06"}}, "the place of a chunk");
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
      kBagHead + bag_chunk("none", bag_connection(0, "/left/events", "dvs_msgs/EventArray") +
                                       bag_connection(1, "/right/events", "dvs_msgs/EventArray") +
                                       bag_message(0, event_array(left)) +
                                       bag_message(1, event_array(right))));
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
  const std::string at = "r.bag:byte " + std::to_string(kBagHead.size()) + ": ";
  const std::string good =
      kBagHead + bag_chunk("none", events_ + bag_message(4, event_array(events)));
  EXPECT_THAT(error(good.substr(0, good.size() - 1)), HasSubstr("the file ends within the data"));
  EXPECT_THAT(error(kBagHead + bag_chunk("zip", "")),
              HasSubstr(at + "the chunk is compressed by 'zip'"));
  EXPECT_THAT(error(kBagHead + bag_chunk("none", bag_message(3, ""))),
              HasSubstr(at + "a message of the unknown connection 3"));
  EXPECT_THAT(
      error(kBagHead + bag_chunk("none", events_ + bag_message(4, "short"))),
      HasSubstr(at + "in the record that begins here: in a message of /dvs/events: it ends"));
  EXPECT_THAT(
      error(kBagHead +
            bag_chunk("none", events_ + bag_message(4, event_array(Events{{0, 240, 0, 1}})))),
      HasSubstr("event 0: pixel (240, 0) lies outside the sensor of 240 x 180 px"));
  EXPECT_THAT(
      error(kBagHead +
            bag_chunk("none",
                      events_ + bag_message(4, event_array(Events{{5, 0, 0, 1}, {4, 0, 0, 1}})))),
      HasSubstr("event 1: time goes back"));
  EXPECT_THAT(error(kBagHead), HasSubstr("holds no events; it has no topics"));
  EXPECT_THAT(error(kBagHead + "\xFF\xFF\xFF\x7F"),
              HasSubstr("ends within the header of a record"));
}

TEST_F(BagEvents, DamagedFilesAreReportedOrRead) {
  for (const std::string compression : {"none", "lz4", "bz2"}) {
    const std::string bag =
        kBagHead +
        bag_chunk(compression, events_ + bag_message(4, event_array(testing::random_events(5))));
    testing::expect_damage_is_reported(bag, bag.size(), [&](const std::string& bytes) {
      return read_events(write(bytes.size() < kBagMagic.size() ? std::string(1, '\0') : bytes), {});
    });
  }
}

}  // namespace
}  // namespace saccade
