#include "core/io/tables/text_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class TextTable : public ::testing::Test {
 protected:
  NumberTable read(const std::string& text) {
    return read_number_table(folder_.write("t.txt", text), "a b c");
  }
  std::string error(const std::string& text) {
    return error_of([&] { return read(text); });
  }
  TimeNs seconds(const std::string& text) { return TextRow(name_, 7, text).seconds("t"); }

  TemporaryFolder folder_;
  const std::string name_ = "x.txt";
};

TEST_F(TextTable, ReadsSpacesTabsCommasCommentsBlankLinesAndCrLf) {
  const NumberTable table = read("# a b c\n1 2 3\r\n\n  4\t5  6\t\n7,8, 9\n -1e-3 +2 .5");
  EXPECT_EQ(table.values, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, -1e-3, 2, 0.5}));
  EXPECT_EQ(table.lines, (std::vector<std::size_t>{2, 4, 5, 6}));
  EXPECT_EQ(table(2, 1), 8);
  EXPECT_THAT(table.place(1), HasSubstr("t.txt:4"));
}

TEST_F(TextTable, NamesLineAndColumnOfWhatIsWrong) {
  EXPECT_THAT(error("1 2 3\n1 2\n"), HasSubstr("t.txt:2: c: expected a number, found the end"));
  EXPECT_THAT(error("1 2 3 4\n"), HasSubstr("t.txt:1: more fields than expected"));
  EXPECT_THAT(error("1 2x 3\n"), HasSubstr("t.txt:1: b: expected a number, found '2x'"));
  EXPECT_THAT(error("1 2 nan\n"), HasSubstr("t.txt:1: c: expected a finite number, found 'nan'"));
  EXPECT_THAT(error("1 -inf 2\n"), HasSubstr("b: expected a finite number"));
  EXPECT_THAT(error("1 1e999 2\n"), HasSubstr("t.txt:1: b: expected"));
  EXPECT_THAT(error("1,,2\n"), HasSubstr("t.txt:1: a field is empty"));
  EXPECT_THAT(error("1 2 3,\n"), HasSubstr("t.txt:1: more fields"));
}

TEST_F(TextTable, MissingFileAndFolder) {
  EXPECT_THAT(error_of([&] { return read_number_table(folder_.path() / "no", "a"); }),
              HasSubstr("no: no such file"));
  EXPECT_THAT(error_of([&] { return read_number_table(folder_.path(), "a"); }),
              HasSubstr("is a folder"));
}

TEST_F(TextTable, EmptyFileHasNoRows) { EXPECT_EQ(read("").rows(), 0U); }

TEST_F(TextTable, LinesMayStraddleBlocks) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += std::to_string(i) + " 0.25 1234567\n";
  const NumberTable table = read(text);
  ASSERT_EQ(table.rows(), 200'000U);
  for (std::size_t i = 0; i < table.rows(); ++i) ASSERT_EQ(table(i, 0), static_cast<double>(i));
}

TEST_F(TextTable, BinaryFileIsAnError) {
  EXPECT_THAT(error(std::string(3'000'000, 'x')), HasSubstr("no table of text"));
  EXPECT_THAT(error(std::string("\x89PNG\0\n", 6)), HasSubstr("expected a number"));
}

TEST_F(TextTable, SecondsAreExactAlsoAtUnixTimes) {
  EXPECT_EQ(seconds("1468939993.123456789"), 1'468'939'993'123'456'789);
  EXPECT_EQ(seconds("0.003811000"), 3'811'000);
  EXPECT_EQ(seconds("-1.5"), -1'500'000'000);
  EXPECT_EQ(seconds("3"), 3'000'000'000);
  EXPECT_EQ(seconds("3."), 3'000'000'000);
  EXPECT_EQ(seconds(".25"), 250'000'000);
  EXPECT_EQ(seconds("0.9999999995"), 1'000'000'000);
  EXPECT_EQ(seconds("0.00000000149"), 1);
}

TEST_F(TextTable, SecondsTakeExponents) {
  EXPECT_EQ(seconds("1.468939993123456789e9"), 1'468'939'993'123'456'789);
  EXPECT_EQ(seconds("3.811e-3"), 3'811'000);
  EXPECT_EQ(seconds("-25E-1"), -2'500'000'000);
  EXPECT_EQ(seconds("1e+1"), 10'000'000'000);
  EXPECT_EQ(seconds("1e-300"), 0);
}

TEST_F(TextTable, SecondsRefuseEverythingElse) {
  for (const char* text : {"", "x", "1.2.3", "1e", "1e99", "--1", "nan", "99999999999", "1s", "."})
    EXPECT_THAT(error_of([&] { return seconds(text); }), HasSubstr("x.txt:7: t: expected a time"))
        << text;
}

TEST_F(TextTable, DecimalSecondsReadBack) {
  for (const TimeNs t : {0L, 1L, -1L, 999'999'999L, -1'000'000'001L, 1'468'939'993'123'456'789L})
    EXPECT_EQ(seconds(decimal_seconds(t)), t);
  EXPECT_EQ(decimal_seconds(-5), "-0.000000005");
}

TEST_F(TextTable, WholeNumbers) {
  EXPECT_EQ(TextRow(name_, 1, "-12").integer("i"), -12);
  EXPECT_EQ(TextRow(name_, 1, "1403636580838555648").integer("i"), 1'403'636'580'838'555'648)
      << "ns since 1970 have 19 digits";
  EXPECT_THAT(error_of([&] { return TextRow(name_, 1, "1.5").integer("i"); }),
              HasSubstr("i: expected a whole number, found '1.5'"));
  EXPECT_THAT(error_of([&] { return TextRow(name_, 1, "99999999999999999999").integer("i"); }),
              HasSubstr("whole number"));
}

}  // namespace
}  // namespace saccade
