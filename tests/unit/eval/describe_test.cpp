#include "eval/describe.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "eval/evaluate.h"
#include "tests/support/shared_data.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class Describe : public testing::FakeFolders {};

void expect_lines(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST_F(Describe, ADataset) {
  const PathDescription d = describe_path(dataset());
  expect_lines(d.text, {"dataset walls", "80 x 60 px", "% ON", "events/s mean",
                        "251, 0.000 .. 0.250 s", "mean depth", "ON 0.15 OFF 0.15"});
  EXPECT_TRUE(d.problems.empty());
}

TEST_F(Describe, VerifiesHashes) {
  EXPECT_TRUE(describe_path(dataset(), true).problems.empty());
  TemporaryFolder folder;
  fs::copy(dataset(), folder.path() / "data", fs::copy_options::recursive);
  folder.write("data/calib.txt", "70 70 40 30 0 0 0 0 0\n");
  const PathDescription d = describe_path(folder.path() / "data", true);
  ASSERT_EQ(d.problems.size(), 1U);
  EXPECT_NE(d.problems[0].find("calib.txt"), std::string::npos);
}

TEST_F(Describe, ARun) {
  expect_lines(describe_path(run()).text,
               {"run walls_accurate", "track", "0.1.0 (test)", "175,", "samples: 500"});
  (void)evaluate_run(run());
  expect_lines(describe_path(run()).text, {"dt_rel [%]"});
  EXPECT_THROW((void)describe_path(run(), true), InputError);
}

TEST_F(Describe, AnEventFile) {
  expect_lines(describe_path(dataset() / "events.h5").text,
               {"format       HDF5", "stamps in us", "sensor       80 x 60 px"});
  TemporaryFolder folder;
  expect_lines(
      describe_path(folder.write("e.txt", "0.001 3 4 1\n0.002 5 6 0\n0.003 5 6 0\n")).text,
      {"not stated, at least 6 x 7 px", "3 (1 ON, 2 OFF: 33.3 % ON)", "0.001000 .. 0.003000 s"});
}

TEST_F(Describe, RefusesAnythingElse) {
  TemporaryFolder folder;
  EXPECT_THROW((void)describe_path(folder.path()), InputError);
  EXPECT_THROW((void)describe_path(folder.path() / "none"), InputError);
  EXPECT_THROW((void)describe_path(dataset() / "events.h5", true), InputError);
}

TEST(DescribeRecording, SliderDepth) {
  SACCADE_SHARED_DATA_OR_SKIP(folder, "slider_depth");
  expect_lines(describe_path(folder).text,
               {"50,000 (21,147 ON, 28,853 OFF: 42.3 % ON)", "339,", "87,", "k1 -0.1386"});
}

}  // namespace
}  // namespace saccade
