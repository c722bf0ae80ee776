#include "estimator/external/command_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;

TEST(CommandTemplate, PutsValuesIntoWords) {
  const Placeholders values{{"events", "/a folder/events.txt"}, {"out", "/out"}};
  EXPECT_THAT(substituted_words("run --in={events} '{out}/a b' {{x}}", values),
              ElementsAre("run", "--in=/a folder/events.txt", "/out/a b", "{x}"));
}

TEST(CommandTemplate, AValueNeverBecomesASecondWord) {
  const std::string hostile = "/d'; rm -rf \"$HOME\" #`id` $(id)\n{out}";
  const Placeholders values{{"events", hostile}, {"out", "/out"}};
  EXPECT_THAT(substituted_words("run {events} '{events}' --to {out}", values),
              ElementsAre("run", hostile, hostile, "--to", "/out"));
}

TEST(CommandTemplate, KnowsWhatItHolds) {
  EXPECT_TRUE(uses_placeholder("a {imu} b", "imu"));
  EXPECT_FALSE(uses_placeholder("a {{imu}} {imux}", "imu"));
}

TEST(AdapterConfig, NamesTheWrongPlaceholder) {
  const auto error = [](const std::string& yaml) {
    return error_of([&] { return config::read<AdapterConfig>(config::parse(yaml, "t.yaml")); });
  };
  EXPECT_THAT(error("{command: 'x {event}'}"), HasSubstr("did you mean 'events'?"));
  EXPECT_THAT(error("{command: 'x {nowhere_near}'}"), HasSubstr("valid placeholders: events"));
  EXPECT_THAT(error("{command: 'x {events'}"), HasSubstr("{{ or }}"));
  EXPECT_THAT(error("{command: 'x {groundtruth_start}'}"), HasSubstr("start.truth_s"));
  EXPECT_THAT(error("{command: 'env A={programm} x', files: {program: x.py}}"),
              HasSubstr("did you mean 'program'?"));
  EXPECT_THAT(error("{output: {trajectory: {columns: kitti}}}"), HasSubstr("tum"));
  EXPECT_EQ(error("{command: '{program} {events} {out}', files: {program: x.py}}"), "no error");
}

}  // namespace
}  // namespace saccade
