#include "eval/report/reference/published_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;

std::string table(const std::string& more) {
  return "tables:\n"
         "  - dataset: D\n"
         "    metric: trajectory.sim3.ate_rmse_m\n"
         "    protocol: all poses\n"
         "    citation: somebody\n"
         "    url: nowhere\n"
         "    methods: [{name: A, sensors: events}, {name: B, sensors: events}]\n" +
         more;
}

TEST(PublishedRows, ReadsWhatIsPublished) {
  const testing::TemporaryFolder folder;
  const auto rows = read_published_rows(
      folder.write("p.yaml", table("    sequences: {one: [1.5, ~], two: [2, 0]}\n")));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].sequence, "one");
  EXPECT_EQ(rows[0].method, "A");
  EXPECT_EQ(rows[0].value, 1.5);
  EXPECT_EQ(rows[0].citation, "somebody");
  EXPECT_EQ(rows[2].method, "B");
}

TEST(PublishedRows, RefusesWhatIsIncomplete) {
  const testing::TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return testing::error_of([&] { return read_published_rows(folder.write("p.yaml", text)); });
  };
  EXPECT_THAT(error(table("    sequences: {one: [1]}\n")), HasSubstr("1 values for 2 methods"));
  EXPECT_THAT(error(table("    sequences: {one: [1, -2]}\n")), HasSubstr("negative"));
  EXPECT_THAT(error(table("    sequence: {one: [1, 2]}\n")), HasSubstr("'sequences'"));
  EXPECT_THAT(error("tables: [{dataset: D}]\n"), HasSubstr("citation"));
}

TEST(PublishedRows, TheShippedOnesNameTheirSource) {
  const auto rows = read_published_rows(testing::source_path("reports/published.yaml"));
  EXPECT_EQ(rows.size(), 72U);
  for (const PublishedRow& row : rows) {
    EXPECT_THAT(row.url, HasSubstr("https://"));
    EXPECT_FALSE(row.paper.empty());
  }
  const auto found = std::find_if(rows.begin(), rows.end(), [](const PublishedRow& row) {
    return row.sequence == "boxes_6dof" && row.method == "Ultimate SLAM EIO";
  });
  ASSERT_NE(found, rows.end());
  EXPECT_EQ(found->value, 0.44);
}

}  // namespace
}  // namespace saccade
