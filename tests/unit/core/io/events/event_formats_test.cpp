#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/io/events/event_file.h"
#include "tests/support/command.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::kSensor;
using testing::random_events;

/// What every row of the table promises.
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

 private:
  testing::TemporaryFolder folder_;
};

TEST_P(EveryEventFormat, ReadsWhatItWrites) {
  Events events = random_events(20'000);
  const fs::path file = written("events", events);
  sort_ties(events);
  EXPECT_EQ(read_events(file, kSensor), events);
  const TimeWindow window{events[5'000].t_ns, events[15'000].t_ns};
  for (const Event& event : read_events(file, kSensor, window)) {
    ASSERT_GE(event.t_ns, window.start_ns);
    ASSERT_LT(event.t_ns, window.end_ns);
  }
  const EventFileInfo info = read_event_file_info(file);
  EXPECT_EQ(info.count, events.size());
  EXPECT_EQ(info.first_ns, events.front().t_ns);
  EXPECT_EQ(info.last_ns, events.back().t_ns);
  EXPECT_EQ(stated_sensor(file).width, GetParam().states_sensor ? kSensor.width : 0);
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

INSTANTIATE_TEST_SUITE_P(All, EveryEventFormat,
                         ::testing::ValuesIn(event_formats().begin(), event_formats().end()),
                         [](const auto& format) {
                           return std::string(format.param.ending.substr(1));
                         });

}  // namespace
}  // namespace saccade
