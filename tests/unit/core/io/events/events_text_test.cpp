#include "core/io/events/events_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/tables/text_table.h"
#include "core/process/parallel.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::kSensor;
using testing::TemporaryFolder;

Events parse_events(const std::string& text, TimeWindow window = {}) {
  const TemporaryFolder folder;
  return read_events(folder.write("events.txt", text), kSensor, window);
}

std::string parse_error(const std::string& text) {
  return error_of([&] { return parse_events(text); });
}

TEST(EventsText, ReadsBothPolarityConventions) {
  const Events events =
      parse_events("# t x y p\n0.000000001 1 2 1\n0.5 3 4 0\n1468939993.123456789 5 6 -1\n");
  EXPECT_EQ(events,
            (Events{{1, 1, 2, 1}, {500'000'000, 3, 4, -1}, {1'468'939'993'123'456'789, 5, 6, -1}}));
}

TEST(EventsText, SortsTies) {
  EXPECT_EQ(parse_events("1 5 1 1\n1 4 1 1\n1 4 0 1\n1 4 0 0\n"),
            (Events{{1'000'000'000, 4, 0, -1},
                    {1'000'000'000, 4, 0, 1},
                    {1'000'000'000, 4, 1, 1},
                    {1'000'000'000, 5, 1, 1}}));
}

TEST(EventsText, WindowIsHalfOpen) {
  const std::string text = "1 0 0 1\n2 0 0 1\n3 0 0 1\n4 0 0 1\n";
  const Events events = parse_events(text, {2'000'000'000, 4'000'000'000});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events.front().t_ns, 2'000'000'000);
  EXPECT_EQ(events.back().t_ns, 3'000'000'000);
}

TEST(EventsText, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(parse_error("1 0 0 1\n0.5 0 0 1\n"), HasSubstr("events.txt:2: time goes back: 0.5"));
  EXPECT_THAT(parse_error("1 240 0 1\n"),
              HasSubstr("events.txt:1: x = 240 lies outside the sensor; it must be 0 ... 239"));
  EXPECT_THAT(parse_error("1 0 180 1\n"), HasSubstr("y = 180"));
  EXPECT_THAT(parse_error("1 -1 0 1\n"), HasSubstr("x = -1"));
  EXPECT_THAT(parse_error("1 0 0 2\n"), HasSubstr("events.txt:1: polarity 2"));
  EXPECT_THAT(parse_error("1 0 0\n"), HasSubstr("events.txt:1: p: expected a whole number"));
  EXPECT_THAT(parse_error("1 0 0 1 1\n"), HasSubstr("events.txt:1: more fields"));
  EXPECT_THAT(parse_error("nan 0 0 1\n"), HasSubstr("events.txt:1: t: expected a time"));
  EXPECT_THAT(parse_error("1 1.5 0 1\n"), HasSubstr("x: expected a whole number, found '1.5'"));
}

/// The same lines, each with a blank at its end, which read_usual_line() leaves to the general reader.
std::string in_general_form(const std::string& text) {
  std::string general;
  for (const char c : text) {
    if (c == '\n') general += ' ';
    general += c;
  }
  return general;
}

// What one of the two ways to read a line takes, the other takes, and what one refuses.
TEST(EventsText, LinesOfUsualFormAreReadAsAllOthers) {
  const std::string behind = "9999999.5 1 2 1\n9999999.5 2 2 1\n9999999.5 3 2 1\n9999999.5 4 2 1\n";
  for (const std::string time : {"0.0", "1.5", "12.25", "0.123456789", "0.12345678", "1.000000001",
                                 "9999999.999999999", "1.1234567894", "1.1234567895", "1", "1.",
                                 ".5", "12345678.5", "+1.5", "-1.5", "1e0", "1.5e1", "", "1.5.5"})
    for (const std::string place :
         {"0 0", "239 179", "007 7", "240 0", "0 180", "65536 0", "-1 0", "12345678 1",
          "99999999999 1", "1", "1  2", "1\t2", "1,2", "1.5 2"})
      for (const std::string polarity : {"0", "1", "-1", "2", "01", "", "1 1", "1\r"}) {
        std::string line = time;
        line += ' ';
        line += place;
        line += ' ';
        line += polarity;
        line += '\n';
        line += behind;
        SCOPED_TRACE(line);
        const std::string error = parse_error(line);
        const std::string general_error = parse_error(in_general_form(line));
        ASSERT_EQ(error.substr(error.rfind('/') + 1),
                  general_error.substr(general_error.rfind('/') + 1));
        if (error != "no error") continue;
        ASSERT_EQ(parse_events(line), parse_events(in_general_form(line)));
      }
}

TEST(EventsText, EmptyFileHoldsNoEvents) {
  EXPECT_TRUE(parse_events("").empty());
  EXPECT_TRUE(parse_events("# nothing\n").empty());
}

TEST(EventsText, RoundTripIsExact) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "events.txt";
  const Events events = testing::random_events(100'000, 1'468'939'993'000'000'000);
  EventTextWriter writer(file);
  writer.append(std::span(events).first(5));
  writer.append(std::span(events).subspan(5));
  EXPECT_FALSE(fs::exists(file));
  writer.close();
  EXPECT_EQ(writer.count(), events.size());
  Events sorted = events;
  sort_ties(sorted);
  EXPECT_EQ(read_events(file, kSensor), sorted);
  const EventFileInfo info = read_event_file_info(file);
  EXPECT_EQ(info.count, events.size());
  EXPECT_EQ(info.first_ns, events.front().t_ns);
  EXPECT_EQ(info.last_ns, events.back().t_ns);
}

/// Lines for several blocks, with comments and blank lines between them.
class LongEventsText : public ::testing::Test {
 protected:
  static constexpr int kLines = 200'000;

  LongEventsText() {
    for (int i = 0; i < kLines; ++i) {
      if (i % 1000 == 0) lines_.emplace_back(i % 2000 == 0 ? "# comment" : "");
      lines_.push_back(decimal_seconds(1000 * i) + " " + std::to_string(i % 240) + " 7 1");
    }
  }

  [[nodiscard]] std::string text() const {
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    return text;
  }

  std::vector<std::string> lines_;
};

TEST_F(LongEventsText, IsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("events.txt", text());
  std::vector<std::string> copies;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    const Events events = read_events(file, kSensor);
    ASSERT_EQ(events.size(), static_cast<std::size_t>(kLines));
    for (int i = 0; i < kLines; ++i)
      ASSERT_EQ(events[static_cast<std::size_t>(i)],
                (Event{1000 * i, static_cast<std::uint16_t>(i % 240), 7, 1}));
    EventTextWriter writer(folder.path() / "copy.txt");
    writer.append(std::span(events).first(3));
    writer.append(std::span(events).subspan(3));
    writer.close();
    copies.push_back(testing::read_file(folder.path() / "copy.txt"));
  }
  set_thread_count(0);
  EXPECT_EQ(copies[0], copies[1]);
  EXPECT_EQ(copies[0], copies[2]);
  EXPECT_EQ(copies[0].substr(0, 32), "0.000000000 0 7 1\n0.000001000 1 ");
}

TEST_F(LongEventsText, TheFirstOfSeveralErrorsIsNamedWithItsLine) {
  lines_[150'000] = "0.150 1 7 2";
  lines_[190'000] = "no event";
  EXPECT_THAT(parse_error(text()), HasSubstr("events.txt:150001: polarity 2"));
  lines_[100'000] = "1e-9 1 7 1";
  EXPECT_THAT(parse_error(text()), HasSubstr("events.txt:100001: time goes back"));
}

TEST_F(LongEventsText, TimeMayNotGoBackFromOneBlockToTheNext) {
  // One line in each place, so that some of them begin a part of the text.
  for (std::size_t i = 40'000; i < 40'400; ++i) lines_[i] = "# " + std::string(4'000, '-');
  for (const std::size_t at : {40'010U, 40'100U, 40'263U, 40'399U}) {
    std::vector<std::string> before = lines_;
    lines_[at] = "0.000000001 1 7 1";
    EXPECT_THAT(parse_error(text()),
                HasSubstr("events.txt:" + std::to_string(at + 1) + ": time goes back"));
    lines_ = before;
  }
}

TEST_F(LongEventsText, BehindTheWindowNothingIsRead) {
  lines_.push_back("no event");
  EXPECT_EQ(parse_events(text(), {50'000'000, 150'000'000}).size(), 100'000U);
}

TEST(EventsText, WithoutCloseNothingIsWritten) {
  const TemporaryFolder folder;
  {
    EventTextWriter writer(folder.path() / "events.txt");
    writer.append(testing::random_events(10));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace saccade
