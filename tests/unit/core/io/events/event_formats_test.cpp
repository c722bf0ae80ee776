#include "core/io/events/event_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/io/events/rounded_events.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::kSensor;
using testing::random_events;

std::vector<EventFormat> written_formats() {
  std::vector<EventFormat> formats;
  std::copy_if(event_formats().begin(), event_formats().end(), std::back_inserter(formats),
               [](const EventFormat& format) { return format.make_writer != nullptr; });
  return formats;
}

/// What every row of the table that is written promises.
class EveryEventFormat : public ::testing::TestWithParam<EventFormat> {
 protected:
  [[nodiscard]] fs::path written(const std::string& name, const Events& events) const {
    const fs::path file = folder_.path() / (name + std::string(GetParam().ending));
    const std::unique_ptr<EventWriter> writer =
        GetParam().make_writer(file, TimestampUnit::kNanoseconds, kSensor);
    const auto half = static_cast<std::ptrdiff_t>(events.size() / 2);
    writer->append(std::span(events.begin(), events.begin() + half));
    writer->append(std::span(events.begin() + half, events.end()));
    writer->close();
    EXPECT_EQ(writer->count(), events.size());
    return file;
  }

  /// As the format can hold them.
  [[nodiscard]] static Events rounded(const Events& events) {
    RoundedEvents result(GetParam().finest);
    result.add(events);
    result.finish();
    return {result.complete().begin(), result.complete().end()};
  }

  void expect_same_again(const Events& events) const {
    const fs::path file = written("events", events);
    const Events expected = rounded(events);
    EXPECT_EQ(read_events(file, kSensor), expected);
    const EventFileInfo info = read_event_file_info(file);
    EXPECT_EQ(info.count, events.size());
    EXPECT_EQ(info.first_ns, expected.front().t_ns);
    EXPECT_EQ(info.last_ns, expected.back().t_ns);
  }

  testing::TemporaryFolder folder_;
};

TEST_P(EveryEventFormat, ReadsWhatItWrites) { expect_same_again(random_events(20'000)); }

TEST_P(EveryEventFormat, KeepsSparseEventsAndTimesFarFromZero) {
  constexpr TimeNs kSecond = 1'000'000'000;
  expect_same_again(random_events(50, 0, 20 * kSecond));
  expect_same_again(random_events(1000, 1'468'939'993'123'456'000));
}

TEST_P(EveryEventFormat, StatesTheSensorAndIsRecognisedUnderAnyName) {
  const Events events = random_events(1000);
  const fs::path file = written("events", events);
  EXPECT_EQ(recognise_event_format(file).name, GetParam().name);
  const SensorSize stated = stated_sensor(file);
  EXPECT_EQ(stated.width, GetParam().states_sensor ? kSensor.width : 0);
  EXPECT_EQ(stated.height, GetParam().states_sensor ? kSensor.height : 0);
  fs::rename(file, folder_.path() / "renamed.bin");
  EXPECT_EQ(read_events(folder_.path() / "renamed.bin", kSensor), rounded(events));
}

TEST_P(EveryEventFormat, WindowsSelectExactlyTheirEvents) {
  const Events events = random_events(200'000);
  const fs::path file = written("events", events);
  const Events all = rounded(events);
  const TimeNs middle = all[all.size() / 2].t_ns;
  for (const TimeWindow window : {TimeWindow{all[5'000].t_ns, all[150'000].t_ns},
                                  {middle, middle + 1},
                                  {middle, middle},
                                  {all.back().t_ns, all.back().t_ns + 1},
                                  {all.back().t_ns + 1, all.back().t_ns + 2}}) {
    Events expected;
    std::copy_if(all.begin(), all.end(), std::back_inserter(expected), [&](const Event& event) {
      return event.t_ns >= window.start_ns && event.t_ns < window.end_ns;
    });
    EXPECT_EQ(read_events(file, kSensor, window), expected)
        << window.start_ns << " " << window.end_ns;
  }
}

TEST_P(EveryEventFormat, StreamsGiveTheSameInWholeRunsOfEqualTime) {
  // Times of 100 us leave runs that reach from one block into the next.
  Events events = random_events(150'000);
  for (Event& event : events) event.t_ns -= event.t_ns % 100'000;
  sort_ties(events);
  EventStream stream(written("events", events), kSensor);
  Events all;
  for (auto part = stream.next(); !part.empty(); part = stream.next()) {
    EXPECT_TRUE(all.empty() || all.back().t_ns < part.front().t_ns);
    all.insert(all.end(), part.begin(), part.end());
  }
  EXPECT_EQ(all, events);
  EXPECT_TRUE(stream.next().empty());
}

TEST_P(EveryEventFormat, ChecksCoordinatesAgainstTheSensor) {
  Events events = random_events(1000);
  const fs::path file = written("events", events);
  EXPECT_THAT(testing::error_of([&] {
                return read_events(file, {100, kSensor.height});
              }),
              HasSubstr("outside the sensor"));
  EXPECT_THAT(testing::error_of([&] {
                return read_events(file, {kSensor.width, 100});
              }),
              HasSubstr("outside the sensor"));
}

TEST_P(EveryEventFormat, BytesDependOnTheEventsAlone) {
  const Events events = random_events(5'000);
  EXPECT_EQ(testing::read_file(written("a", events)), testing::read_file(written("b", events)));
}

TEST_P(EveryEventFormat, MayHoldNothing) {
  const fs::path file = written("events", {});
  EXPECT_TRUE(read_events(file, kSensor).empty());
  EXPECT_EQ(read_event_file_info(file).count, 0U);
}

TEST_P(EveryEventFormat, SaysWhatItHolds) {
  EXPECT_TRUE(GetParam().help.ends_with('.'));
  EXPECT_NE(event_file_names().find("events" + std::string(GetParam().ending)), std::string::npos);
}

TEST_P(EveryEventFormat, WithoutCloseNothingIsWritten) {
  {
    const fs::path file = folder_.path() / ("e" + std::string(GetParam().ending));
    const auto writer = GetParam().make_writer(file, TimestampUnit::kNanoseconds, {});
    writer->append(random_events(10));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

INSTANTIATE_TEST_SUITE_P(All, EveryEventFormat, ::testing::ValuesIn(written_formats()),
                         [](const auto& format) {
                           std::string name = std::string(format.param.name) +
                                              std::string(format.param.ending.substr(1));
                           std::erase_if(name, [](char c) {
                             return std::isalnum(static_cast<unsigned char>(c)) == 0;
                           });
                           return name;
                         });

TEST(EventFormats, NamesTheFormatsWhereNoneIsRecognised) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.write("events.h5", std::string("\x01\x02\x03\x00\xFF", 5));
  const std::string error = testing::error_of([&] { return read_events(file, {}); });
  EXPECT_THAT(error, HasSubstr("events.h5: holds events in none of the formats that are read"));
  EXPECT_THAT(error, HasSubstr("HDF5, "));
  EXPECT_THAT(error, HasSubstr("01 02 03 00 ff"));
  EXPECT_THAT(testing::error_of([&] { return read_events(folder.path() / "no.h5", {}); }),
              HasSubstr("no such file"));
  EXPECT_THAT(testing::error_of([&] { return read_events(folder.path(), {}); }),
              HasSubstr("is a folder"));
}

}  // namespace
}  // namespace saccade
