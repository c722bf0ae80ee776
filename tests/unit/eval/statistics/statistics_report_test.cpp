#include "eval/statistics/statistics_report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/error.h"
#include "tests/support/shared_data.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class StatisticsReport : public testing::FakeFolders {};

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST_F(StatisticsReport, ADatasetAndAnEventFileSideBySide) {
  TemporaryFolder folder;
  const fs::path file = folder.write("few.txt", "0.001 3 4 1\n0.002 5 6 0\n0.004 5 6 0\n");
  const std::vector<StreamStatistics> both{statistics_of_recording(dataset() / ""),
                                           statistics_of_recording(file)};
  EXPECT_EQ(both[0].name, dataset().filename().string());
  EXPECT_EQ(both[0].pixels.ascending_hz.size(), 80U * 60U);
  EXPECT_EQ(both[1].name, "few.txt");
  EXPECT_EQ(both[1].pixels.ascending_hz.size(), 6U * 7U);
  EXPECT_NE(statistics_table(both).find("few.txt"), std::string::npos);

  write_statistics(both, folder.path() / "out");
  EXPECT_EQ(contents(folder.path() / "out/statistics.csv").find("recording,events,duration_s"), 0U);
  EXPECT_NE(contents(folder.path() / "out/statistics.csv").find("few.txt,3,0.003,"),
            std::string::npos);
  EXPECT_EQ(contents(folder.path() / "out/rates.csv").find("recording,t_s,on_hz,off_hz\n"), 0U);
  EXPECT_NE(contents(folder.path() / "out/gaps.csv").find("few.txt,"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder.path() / "out/statistics.png"));
}

TEST_F(StatisticsReport, APartOfARecording) {
  TemporaryFolder folder;
  const fs::path file =
      folder.write("e.txt", "10.001 3 4 1\n10.002 5 6 0\n10.004 5 6 0\n10.009 5 6 1\n");
  EXPECT_EQ(statistics_of_recording(file, {.start_s = {}, .duration_s = 0.005}).events, 3U);
  EXPECT_EQ(statistics_of_recording(file, {.start_s = 10.002, .duration_s = {}}).events, 3U);
  EXPECT_EQ(statistics_of_recording(file, {.start_s = 10.002, .duration_s = 0.005}).events, 2U);
}

TEST_F(StatisticsReport, RefusesMoreThanADayHoweverFarTheTimesAreApart) {
  TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& text) {
    EXPECT_THROW((void)statistics_of_recording(folder.write(name, text)), InputError) << name;
  };
  refused("day.txt", "0.001 3 4 1\n86401 5 6 0\n");
  // The difference is beyond 64 bits of nanoseconds.
  refused("all.txt", "-9000000000 3 4 1\n9000000000 5 6 0\n");
}

TEST_F(StatisticsReport, RefusesWhatHasNoTwoEvents) {
  TemporaryFolder folder;
  EXPECT_THROW((void)statistics_of_recording(folder.path() / "none"), InputError);
  const fs::path one = folder.write("one.txt", "0.001 3 4 1\n0.001 5 6 1\n");
  EXPECT_THROW((void)statistics_of_recording(one), InputError);
  EXPECT_THROW((void)statistics_of_recording(dataset(), {.start_s = 1e6, .duration_s = {}}),
               InputError);
}

}  // namespace
}  // namespace saccade
