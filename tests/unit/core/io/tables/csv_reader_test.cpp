#include "core/io/tables/csv_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/io/tables/csv_file.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

TEST(CsvColumns, ReadsWhatCsvTableWrites) {
  CsvTable table({"t_s", "status", "count"});
  table.add({1.0 / 3, std::string("ok"), 7LL});
  table.add({std::nan(""), std::string("lost"), -1LL});
  TemporaryFolder folder;
  table.save(folder.path() / "a.csv");
  const CsvColumns csv(folder.path() / "a.csv");
  ASSERT_EQ(csv.rows(), 2U);
  EXPECT_EQ(csv.number(0, csv.require("t_s")), 1.0 / 3);
  EXPECT_TRUE(std::isnan(csv.number(1, csv.require("t_s"))));
  EXPECT_EQ(csv.text(1, csv.require("status")), "lost");
  EXPECT_EQ(csv.number(1, csv.require("count")), -1);
  EXPECT_FALSE(csv.find("nothing"));
}

TEST(CsvColumns, NamesThePlaceOfAnError) {
  TemporaryFolder folder;
  EXPECT_THROW(CsvColumns(folder.write("empty.csv", "")), InputError);
  EXPECT_THROW(CsvColumns(folder.write("short.csv", "a,b\n1\n")), InputError);
  const CsvColumns csv(folder.write("text.csv", "a,b\n1,2\n3,x\n"));
  EXPECT_THROW((void)csv.require("c"), InputError);
  try {
    (void)csv.number(1, 1);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("text.csv:3"), std::string::npos);
  }
}

}  // namespace
}  // namespace saccade
