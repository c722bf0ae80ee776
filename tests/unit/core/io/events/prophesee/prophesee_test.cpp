#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/events/prophesee/evt3.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_data.h"
#include "tests/unit/core/io/events/event_hash.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

constexpr const char* kEvt3Head = "% evt 3.0\n% geometry 640x480\n% end\n";
constexpr const char* kEvt2Head = "% evt 2.0\n% geometry 640x480\n% end\n";

template <class Word>
std::string file_of(const std::string& head, const std::vector<Word>& words) {
  std::string text = head;
  text.append(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(Word));
  return text;
}

class Prophesee : public ::testing::Test {
 protected:
  [[nodiscard]] Events read(const std::string& bytes, SensorSize size = {}) const {
    return read_events(folder_.write("file.raw", bytes), size);
  }
  [[nodiscard]] Events read_evt3(const std::vector<std::uint16_t>& words) const {
    return read(file_of(kEvt3Head, words));
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read(bytes); });
  }
  [[nodiscard]] std::string evt3_error(const std::vector<std::uint16_t>& words) const {
    return error(file_of(kEvt3Head, words));
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Prophesee, ARealEvt3RecordingIsReadEventByEvent) {
  SACCADE_SHARED_DATA_OR_SKIP(file, "formats/expelliarmus_evt3.raw");
  EXPECT_EQ(recognise_event_format(file).name, "EVT3");
  EXPECT_EQ(stated_sensor(file).width, 1280) << "by the plug-in, gen41";
  const Events events = read_events(file, {1280, 720});
  ASSERT_EQ(events.size(), 219'596U);
  EXPECT_EQ(events.front(), (Event{11'718'656'000, 806, 200, 1}));
  EXPECT_EQ(events.back(), (Event{11'727'457'000, 1249, 573, -1}));
  // Column, row and polarity of every event are those that expelliarmus 1.1 gives; its times are
  // the same but for 4096 us that it adds wherever a word of time is repeated without events.
  EXPECT_EQ(testing::event_hash(events),
            "773238f9e13ffe3ba85d867bbee4c0570135093b7bd4527043a63b9656072494");
}

TEST_F(Prophesee, Evt3WordsChangeTheStateOfTheDecoder) {
  EXPECT_EQ(read_evt3({0x8001, 0x6005, 0x0014, 0x2803, 0x2004,  // row 20: 3 ON, 4 OFF
                       0x3864, 0x4803, 0x4001, 0x5080,          // from 100: 0, 1, 11; 12; 31
                       0xA001, 0xE123, 0xF000, 0x7000,          // triggers and others
                       0x6006, 0x2001, 0x8002, 0x2002}),
            (Events{{4'101'000, 3, 20, 1},
                    {4'101'000, 4, 20, -1},
                    {4'101'000, 100, 20, 1},
                    {4'101'000, 101, 20, 1},
                    {4'101'000, 111, 20, 1},
                    {4'101'000, 112, 20, 1},
                    {4'101'000, 131, 20, 1},
                    {4'102'000, 1, 20, -1},
                    {8'192'000, 2, 20, -1}}));
}

TEST_F(Prophesee, Evt3LeavesOutWhatHasNoTime) {
  EXPECT_EQ(read_evt3({0x0014, 0x2003, 0x6005, 0x2004, 0x3000, 0x4FFF, 0x8001, 0x2005}),
            (Events{{4'096'000, 5, 20, -1}}));
}

TEST_F(Prophesee, Evt3TimeWraps) {
  const Events events =
      read_evt3({0x8FFF, 0x0001, 0x2001, 0x8000, 0x2002, 0x8FFF, 0x2003, 0x8001, 0x2004});
  std::vector<TimeNs> times;
  for (const Event& event : events) times.push_back(event.t_ns / 4'096'000);
  EXPECT_EQ(times, (std::vector<TimeNs>{4095, 4096, 8191, 8193}));
}

TEST_F(Prophesee, Evt3RepeatedTimesWithoutEventsAreNoFault) {
  EXPECT_EQ(read_evt3({0x8001, 0x0001, 0x6003, 0x2001, 0x6009, 0x6004, 0x2002}),
            (Events{{4'099'000, 1, 1, -1}, {4'100'000, 2, 1, -1}}));
}

TEST_F(Prophesee, Evt3NamesTheByteOfWhatIsWrong) {
  const std::size_t head = std::string(kEvt3Head).size();
  const auto at = [&](std::size_t word) {
    return "file.raw:byte " + std::to_string(head + 2 * word) + ": ";
  };
  EXPECT_THAT(evt3_error({0x8001, 0x0001, 0x2280}),
              HasSubstr(at(2) + "pixel (640, 1) lies outside the sensor of 640 x 480 px"));
  EXPECT_THAT(evt3_error({0x8001, 0x01E0, 0x2001}), HasSubstr(at(2) + "pixel (1, 480)"));
  EXPECT_THAT(evt3_error({0x8001, 0x0001, 0x3279, 0x40FF}), HasSubstr(at(3) + "pixel (640, 1)"));
  EXPECT_THAT(evt3_error({0x8001, 0x0001, 0x6003, 0x2001, 0x6002, 0x2002}),
              HasSubstr(at(5) + "time goes back: 0.004098 s after 0.004099 s"));
  EXPECT_THAT(evt3_error({0x8003, 0x0001, 0x2001, 0x8002, 0x2002}), HasSubstr("time goes back"));
  EXPECT_THAT(evt3_error({0x8001, 0x1001}), HasSubstr(at(1) + "word 1001 is of a type"));
  EXPECT_THAT(error(file_of<std::uint16_t>(kEvt3Head, {0x8001}) + "x"),
              HasSubstr(at(1) + "the file ends within a word of 2 bytes"));
  EXPECT_THAT(error("% evt 4.0\n% end\n\x01\x02"), HasSubstr("in none of the formats"));
}

TEST_F(Prophesee, Evt3IsDecodedAcrossBlocks) {
  // One row of a thousand columns per us, as vectors: several events per word.
  Events events;
  for (int t = 0; t < 500; ++t)
    for (int x = 0; x < 1000; ++x)
      events.push_back({t * 1000, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(t), 1});
  const fs::path file = folder_.path() / "dense.raw";
  const auto writer = make_evt3_writer(file, TimestampUnit::kMicroseconds, {1000, 500});
  writer->append(events);
  writer->close();
  EXPECT_EQ(read_events(file, {}), events);
  EXPECT_LT(fs::file_size(file), events.size() / 3) << "32 columns in 8 bytes";
}

TEST_F(Prophesee, HeadersStateTheSensorInSeveralWays) {
  const auto size = [&](const std::string& lines) {
    const SensorSize sensor = stated_sensor(
        folder_.write("file.raw", file_of<std::uint16_t>("% evt 3.0\n" + lines, {0x8001})));
    return std::pair(sensor.width, sensor.height);
  };
  EXPECT_EQ(size("% geometry 320x240\n% end\n"), std::pair(320, 240));
  EXPECT_EQ(size("% format EVT3;height=720;width=1280\n% end\n"), std::pair(1280, 720));
  EXPECT_EQ(size("% plugin_name hal_plugin_gen31_evk2\n"), std::pair(640, 480));
  EXPECT_EQ(size("% geometry 320x240\n% plugin_name hal_plugin_imx636_evk4\n"),
            std::pair(320, 240));
  EXPECT_EQ(size("% geometry ten\n"), std::pair(0, 0));
  EXPECT_EQ(size(""), std::pair(0, 0));
}

TEST_F(Prophesee, Evt2HoldsOneEventPerWord) {
  const auto event = [](unsigned type, unsigned t, unsigned x, unsigned y) {
    return type << 28U | t << 22U | x << 11U | y;
  };
  const std::vector<std::uint32_t> words{event(1, 3, 9, 9),    0x80000002, event(1, 3, 10, 20),
                                         event(0, 63, 11, 21), 0xA0000001, 0x8FFFFFFF,
                                         event(1, 0, 1, 2),    0x80000000, event(0, 0, 3, 4)};
  constexpr TimeNs kWrap = std::int64_t{1} << 34U;
  EXPECT_EQ(read(file_of(kEvt2Head, words)), (Events{{131'000, 10, 20, 1},
                                                     {191'000, 11, 21, -1},
                                                     {(kWrap - 64) * 1000, 1, 2, 1},
                                                     {kWrap * 1000, 3, 4, -1}}));
  EXPECT_THAT(error(file_of<std::uint32_t>(kEvt2Head, {0x80000002, event(1, 3, 640, 20)})),
              HasSubstr("byte 39: pixel (640, 20) lies outside the sensor of 640 x 480"));
  EXPECT_THAT(
      error(file_of<std::uint32_t>(kEvt2Head, {0x80000002, event(1, 3, 1, 1), event(1, 2, 1, 1)})),
      HasSubstr("byte 43: time goes back: 0.000130 s after 0.000131 s"));
  EXPECT_THAT(error(file_of<std::uint32_t>(kEvt2Head, {0x50000002})), HasSubstr("of a type"));
  EXPECT_THAT(error(file_of<std::uint32_t>(kEvt2Head, {0x80000002}) + "abc"),
              HasSubstr("byte 39: the file ends within a word of 4 bytes"));
}

TEST_F(Prophesee, Evt21HalvesComeInBothOrders) {
  const std::uint32_t high = 0x80000002;
  const std::uint32_t on = 1U << 28U | 3U << 22U | 64U << 11U | 20U;
  const std::uint32_t mask = 0x80000005;
  const Events expected{{131'000, 64, 20, 1}, {131'000, 66, 20, 1}, {131'000, 95, 20, 1}};
  const std::vector<std::uint32_t> little{0, high, mask, on};
  const std::vector<std::uint32_t> legacy{high, 0, on, mask};
  const std::string head = "% format EVT21;height=480;width=640";
  EXPECT_EQ(read(file_of(head + ";endianness=little\n% end\n", little)), expected);
  EXPECT_EQ(read(file_of(head + ";endianness=legacy\n% end\n", legacy)), expected);
  // Masks whose upper bits are those of a type leave the order open; these do not.
  const std::vector<std::uint32_t> unstated{high, 0x30000000, on, 0x40000000};
  EXPECT_EQ(read(file_of(head + "\n% end\n", unstated)).size(), 1U);
  EXPECT_EQ(
      read(file_of<std::uint32_t>("% evt 2.1\n% end\n", {0x30000000, high, 0x40000001, on})).size(),
      2U);
  EXPECT_THAT(error(file_of(head + ";endianness=legacy\n% end\n",
                            std::vector<std::uint32_t>{high, 0, on | 639U << 11U, 3})),
              HasSubstr("lies outside the sensor"));
}

TEST_F(Prophesee, DatHoldsTimesThatWrap) {
  const std::string head =
      "% Data file containing CD events\n% Version 2\n% Height 480\n"
      "% Width 640\n";
  const auto place = [](unsigned x, unsigned y, unsigned p) { return p << 28U | y << 14U | x; };
  const std::vector<std::uint32_t> words{5, place(10, 20, 1), 0xFFFFFFFF, place(639, 479, 0),
                                         7, place(1, 2, 1)};
  const std::string file = file_of(head + std::string("\x0C\x08", 2), words);
  constexpr TimeNs kWrap = std::int64_t{1} << 32U;
  EXPECT_EQ(read(file), (Events{{5'000, 10, 20, 1},
                                {(kWrap - 1) * 1000, 639, 479, -1},
                                {(kWrap + 7) * 1000, 1, 2, 1}}));
  EXPECT_EQ(stated_sensor(folder_.path() / "file.raw").height, 480);
  EXPECT_THAT(error(file_of(head + std::string("\x00\x08", 2),
                            std::vector<std::uint32_t>{5, place(640, 0, 0)})),
              HasSubstr("pixel (640, 0) lies outside"));
  EXPECT_THAT(
      error(file_of(head + std::string("\x00\x08", 2), std::vector<std::uint32_t>{5, 0, 4, 0})),
      HasSubstr("time goes back"));
  EXPECT_THAT(error(file.substr(0, file.size() - 1)), HasSubstr("ends within a word of 8 bytes"));
}

TEST_F(Prophesee, DamagedFilesAreReportedOrRead) {
  for (const EventFormat& format : event_formats()) {
    if (format.ending != ".raw" || format.make_writer == nullptr) continue;
    const fs::path file = folder_.path() / "small.raw";
    const auto writer = format.make_writer(file, TimestampUnit::kMicroseconds, testing::kSensor);
    writer->append(testing::random_events(60));
    writer->close();
    testing::expect_damage_is_reported(testing::read_file(file), 1, [&](const std::string& bytes) {
      // No byte at all is a text without events.
      return read(bytes.empty() ? std::string(1, '\0') : bytes);
    });
  }
}

TEST_F(Prophesee, WritersRefuseWhatElevenBitsDoNotHold) {
  for (const EventFormat& format : event_formats()) {
    if (format.ending != ".raw" || format.make_writer == nullptr) continue;
    EXPECT_THAT(error_of([&] {
                  return format.make_writer(folder_.path() / "a.raw", {}, {2049, 10}), 0;
                }),
                HasSubstr("up to 2048 x 2048 px"));
    const auto writer = format.make_writer(folder_.path() / "a.raw", {}, {});
    EXPECT_THAT(error_of([&] {
                  writer->append(Events{{0, 2048, 0, 1}, {1000, 0, 0, 1}});
                  writer->close();
                  return 0;
                }),
                HasSubstr("an event at (2048, 0)"));
  }
}

}  // namespace
}  // namespace saccade
