#include "eval/view/event_windows.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

constexpr SensorSize kSize{64, 48};

/// Events that are told apart, 7 us from one to the next.
Events many(std::size_t count) {
  Events events;
  for (std::size_t i = 0; i < count; ++i)
    events.push_back({static_cast<TimeNs>(7000 * i), static_cast<std::uint16_t>(i % 64),
                      static_cast<std::uint16_t>(i / 64 % 48),
                      static_cast<std::int8_t>(i % 3 == 0 ? -1 : 1)});
  return events;
}

std::filesystem::path written(const testing::TemporaryFolder& folder, const std::string& name,
                              const Events& events) {
  const std::filesystem::path file = folder.path() / name;
  const auto writer = make_event_writer(file, TimestampUnit::kMicroseconds, kSize);
  writer->append(events);
  writer->close();
  return file;
}

struct Unpacked {
  std::uint32_t stride = 0;
  Events events;  ///< on the clock of the recording
};

Unpacked unpack(const std::string& bytes, std::int64_t start_us) {
  Unpacked unpacked;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data(), 4);
  std::memcpy(&unpacked.stride, bytes.data() + 4, 4);
  EXPECT_EQ(bytes.size(), 8 + 8 * std::size_t{count});
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t t = 0;
    std::uint16_t column = 0, row = 0;
    std::memcpy(&t, bytes.data() + 8 + 4 * i, 4);
    std::memcpy(&column, bytes.data() + 8 + 4 * count + 2 * i, 2);
    std::memcpy(&row, bytes.data() + 8 + 6 * count + 2 * i, 2);
    unpacked.events.push_back({1000 * (start_us + t), static_cast<std::uint16_t>(column & 0x7fff),
                               row, static_cast<std::int8_t>(column & 0x8000 ? -1 : 1)});
  }
  return unpacked;
}

class EveryFormat : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryFormat, GivesTheEventsOfAWindow) {
  const testing::TemporaryFolder folder;
  const Events events = many(200'000);
  const EventWindows windows(written(folder, GetParam(), events), kSize);
  EXPECT_EQ(windows.info().count, events.size());
  EXPECT_EQ(windows.info().last_ns, events.back().t_ns);
  // Event 1000 comes at 7000 us, event 100000 at 700000 us.
  EXPECT_EQ(windows.count({7'000'000, 700'000'000}), 99'000U);
  const Unpacked all = unpack(pack_events(windows, 7000, 700'000), 7000);
  EXPECT_EQ(all.stride, 1U);
  EXPECT_EQ(all.events, Events(events.begin() + 1000, events.begin() + 100'000));
  EXPECT_TRUE(unpack(pack_events(windows, -5000, 0), -5000).events.empty());
  EXPECT_EQ(unpack(pack_events(windows, -5000, 1), -5000).events,
            Events(events.begin(), events.begin() + 1));
  EXPECT_TRUE(unpack(pack_events(windows, 3'000'000, 4'000'000), 0).events.empty());
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values("events.h5", "events.txt", "events.npz"));

TEST(EventWindows, ThinsByIndexSoThatWindowsFitTogether) {
  const testing::TemporaryFolder folder;
  const Events events = many(10'000);
  const EventWindows windows(written(folder, "events.h5", events), kSize);
  const Unpacked first = unpack(pack_events(windows, 0, 30'000, 10), 0);
  const Unpacked second = unpack(pack_events(windows, 30'000, 70'000, 10), 30'000);
  EXPECT_EQ(first.stride, 10U);
  Events both = first.events, expected;
  both.insert(both.end(), second.events.begin(), second.events.end());
  for (std::size_t i = 0; i < events.size(); i += 10) expected.push_back(events[i]);
  EXPECT_EQ(both, expected);
}

TEST(EventWindows, GivesABoundedNumberAndSaysSo) {
  const testing::TemporaryFolder folder;
  const std::size_t count = kMostPackedEvents + 10;
  const EventWindows windows(written(folder, "events.h5", many(count)), kSize);
  const Unpacked all = unpack(pack_events(windows, 0, 20'000'000), 0);
  EXPECT_EQ(all.stride, 2U);
  EXPECT_EQ(all.events.size(), count / 2);
}

TEST(EventWindows, ADamagedFileIsNamed) {
  const testing::TemporaryFolder folder;
  const EventWindows windows(folder.write("events.txt", "0.1 3 4 1\n0.05 3 4 1\n"), kSize);
  EXPECT_THROW(static_cast<void>(windows.info()), InputError);
  EXPECT_THROW(static_cast<void>(windows.info()), InputError) << "not only the first time";
}

}  // namespace
}  // namespace saccade
