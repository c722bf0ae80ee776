#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/events/aedat/aedat4.h"
#include "core/io/events/aedat/aedat4_file.h"
#include "core/io/events/event_formats.h"
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

class Aedat : public ::testing::Test {
 protected:
  [[nodiscard]] Events read(const std::string& bytes) const {
    return read_events(folder_.write("file.aedat", bytes), {});
  }
  [[nodiscard]] std::string error(const std::string& bytes) const {
    return error_of([&] { return read(bytes); });
  }
  [[nodiscard]] std::string written(const Events& events) const {
    const fs::path file = folder_.path() / "written.aedat4";
    const auto writer = make_aedat4_writer(file, {}, testing::kSensor);
    writer->append(events);
    writer->close();
    return testing::read_file(file);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Aedat, ARealRecordingOfADavisIsReadEventByEvent) {
  SACCADE_SHARED_DATA_OR_SKIP(file, "formats/evl_sample.aedat4");
  SACCADE_SHARED_DATA_OR_SKIP(reference, "real/evl_davis346/events.h5");
  const Aedat4File layout(file);
  ASSERT_EQ(layout.streams().size(), 4U);
  EXPECT_EQ(layout.streams()[1].type, "FRME");
  EXPECT_EQ(layout.streams()[1].sensor.width, 346);
  const Events events = read_events(file, {346, 260});
  Events expected = read_events(reference, {346, 260});
  ASSERT_EQ(events.size(), 6676U);
  // The reference counts from its first event; the recording from 1970.
  EXPECT_EQ(events.front().t_ns / 1'000'000'000, 1'589'163'147);
  for (Event& event : expected) event.t_ns += events.front().t_ns;
  EXPECT_EQ(events, expected);
  EXPECT_EQ(stated_sensor(file).height, 260);
}

TEST_F(Aedat, DamagedFilesAreReportedOrRead) {
  const std::string file = written(testing::random_events(40));
  testing::expect_damage_is_reported(file, file.size() - 1, [&](const std::string& bytes) {
    // Ends between packets cannot be told from the end; no byte at all is a text without events.
    if (bytes.size() < kAedat4Magic.size()) throw InputError("", "too short");
    const Events events = read(bytes);
    if (bytes.size() < file.size() && events.empty()) throw InputError("", "ends between packets");
    return events;
  });
}

TEST_F(Aedat, NamesTheByteOfWhatIsWrong) {
  const std::string file = written(testing::random_events(40));
  EXPECT_THAT(error(file.substr(0, file.size() - 1)), HasSubstr("cannot begin here"));
  std::string other = file;
  other[file.find("EVTS</attr>")] = 'X';
  EXPECT_THAT(error(other), HasSubstr("holds no stream of events"));
  other = file;
  other[file.find("IOHE")] = 'X';
  EXPECT_THAT(error(other), HasSubstr("file.aedat:byte 14: the header is damaged"));
  Events late = testing::random_events(3);
  for (Event& event : late) event.t_ns += 1'000'000'000;
  // Two files behind one another: the packets of the second are earlier.
  const std::string first = written(late);
  const std::string second = written(testing::random_events(3));
  const std::string head = written({});
  EXPECT_THAT(error(first + second.substr(head.size())), HasSubstr("time goes back"));
  EXPECT_THAT(error("#!AER-DAT3.1\r\n#Format: RAW\r\n"), HasSubstr("in none of the formats"));
}

TEST_F(Aedat, ClaimedSizesAreNotAllocated) {
  const std::string head = written({});
  std::string huge = head;
  huge += std::string("\x00\x00\x00\x00\xFF\xFF\xFF\x7F", 8);
  EXPECT_THAT(error(huge), HasSubstr("a packet of 2147483647 bytes of stream 0 cannot begin here"));
}

TEST_F(Aedat, DescriptionsNameTheStreams) {
  const auto streams = parse_aedat4_streams(
      "<dv><node name=\"outInfo\" path=\"/o/\"><node name=\"3\"><attr key=\"typeIdentifier\" "
      "type=\"string\">IMUS</attr></node><node name=\"0\"><attr key=\"typeIdentifier\">EVTS</attr>"
      "<node name=\"info\"><attr key=\"sizeX\">640</attr><attr key=\"sizeY\">480</attr></node>"
      "</node></node><node name=\"other\"><attr key=\"sizeX\">1</attr></node></dv>");
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].id, 3);
  EXPECT_EQ(streams[0].type, "IMUS");
  EXPECT_EQ(streams[1].type, "EVTS");
  EXPECT_EQ(streams[1].sensor.width, 640);
  EXPECT_EQ(streams[1].sensor.height, 480);
  EXPECT_TRUE(parse_aedat4_streams("<node name=\"outInfo\"").empty());
}

/// Records of AEDAT 2.0: address and time, big-endian.
std::string aedat2(const std::vector<std::uint32_t>& numbers,
                   const std::string& chip = "eu.seebetter.ini.chips.davis.DAVIS240C") {
  std::string text = "#!AER-DAT2.0\r\n# a comment\r\n";
  if (!chip.empty()) text += "# AEChip: " + chip + "\r\n";
  for (const std::uint32_t number : numbers)
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift);
  return text;
}

constexpr std::uint32_t davis(std::uint32_t x, std::uint32_t y, bool on) {
  return y << 22U | x << 12U | (on ? 0x800U : 0U);
}

TEST_F(Aedat, Version2CountsFromTheLowerRight) {
  const std::string file =
      aedat2({davis(0, 0, true), 5, 0x80000000 | davis(1, 2, true), 6, davis(7, 7, true) | 0x400U,
              7, davis(239, 179, false), 0xFFFFFFFF, davis(10, 20, true), 3});
  constexpr TimeNs kWrap = std::int64_t{1} << 32U;
  EXPECT_EQ(read(file), (Events{{5'000, 239, 179, 1},
                                {(kWrap - 1) * 1000, 0, 0, -1},
                                {(kWrap + 3) * 1000, 229, 159, 1}}));
  EXPECT_EQ(stated_sensor(folder_.path() / "file.aedat").width, 240);
}

TEST_F(Aedat, Version2NamesWhatIsWrong) {
  EXPECT_THAT(error(aedat2({}, "")), HasSubstr("must name the camera in a line \"# AEChip: ...\""));
  EXPECT_THAT(error(aedat2({}, "ch.unizh.ini.jaer.chip.retina.DVS128")), HasSubstr("it names ch."));
  const std::size_t head = aedat2({}).size();
  EXPECT_THAT(error(aedat2({davis(1, 1, true), 5, davis(240, 1, true), 6})),
              HasSubstr("byte " + std::to_string(head + 8) + ": pixel (-1, 178) lies outside"));
  EXPECT_THAT(error(aedat2({davis(1, 1, true), 5, davis(2, 1, true), 4})),
              HasSubstr("byte " + std::to_string(head + 8) + ": time goes back: 4 us after 5 us"));
  EXPECT_THAT(error(aedat2({davis(1, 1, true), 5}) + "abc"), HasSubstr("ends within an event"));
}

}  // namespace
}  // namespace saccade
