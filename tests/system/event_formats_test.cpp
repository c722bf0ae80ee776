#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/events/event_file.h"
#include "core/random.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::CommandResult;
using ::testing::HasSubstr;
using testing::run_command;

/// Times in us, which every format holds.
Events events_in_us() {
  const Random random(3);
  Events events;
  for (std::uint64_t i = 0; i < 5000; ++i)
    events.push_back({static_cast<TimeNs>(i) * 3000,
                      static_cast<std::uint16_t>(random.below(64, 0, i)),
                      static_cast<std::uint16_t>(random.below(48, 1, i)),
                      static_cast<std::int8_t>(random.below(2, 2, i) == 0 ? -1 : 1)});
  return events;
}

TEST(EventFormatsOfTheCommand, ConvertGoesAroundAllOfThemWithoutLoss) {
  const testing::TemporaryFolder folder;
  fs::path last = folder.path() / "events.h5";
  const auto writer = make_event_writer(last, TimestampUnit::kMicroseconds, {64, 48});
  writer->append(events_in_us());
  writer->close();
  for (const char* name : {"a.raw", "b.aedat4", "c.npz", "d.txt", "e.bag", "f.mcap", "g.h5"}) {
    const fs::path next = folder.path() / name;
    const CommandResult result =
        run_command(SACCADE_COMMAND, {"convert", last.string(), next.string()});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("5000 events"));
    EXPECT_EQ(read_events(next, {}), events_in_us()) << name;
    last = next;
  }
  const CommandResult evt2 = run_command(
      SACCADE_COMMAND,
      {"convert", last.string(), (folder.path() / "f.raw").string(), "--format", "EVT2"});
  EXPECT_EQ(evt2.exit_code, 0) << evt2.output;
  const CommandResult info =
      run_command(SACCADE_COMMAND, {"info", (folder.path() / "f.raw").string()});
  EXPECT_THAT(info.output, HasSubstr("format       EVT2"));
  EXPECT_THAT(info.output, HasSubstr("5,000"));
}

TEST(EventFormatsOfTheCommand, BadFilesEndWithTheirPlaceAndCode2) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.write(
      "late.raw", std::string("% evt 3.0\n% geometry 64x48\n% end\n\x01\x80\x01\x00\x40\x20", 39));
  const CommandResult result =
      run_command(SACCADE_COMMAND, {"convert", file.string(), (folder.path() / "x.h5").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("late.raw:byte 37: pixel (64, 1) lies outside the sensor"));
  EXPECT_FALSE(fs::exists(folder.path() / "x.h5"));
  const CommandResult wrong = run_command(
      SACCADE_COMMAND,
      {"convert", file.string(), (folder.path() / "x.h5").string(), "--format", "EVT2"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("a file with the ending '.h5' is not written as EVT2"));
}

}  // namespace
}  // namespace saccade
