#include "eval/sweep/status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/support/html_page.h"
#include "tests/unit/eval/sweep/sweep_files.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_sweep;
using testing::TemporaryFolder;

/// Two configurations with two seeds each, of which one job is done, one runs and one has failed.
class Status : public ::testing::Test {
 protected:
  Status() {
    sweep_ =
        read_sweep(folder_,
                   "title: A <b>sweep</b>\ndatasets: [{path: recorded}]\n"
                   "configurations: [{file: fast.yaml}, {file: accurate.yaml}]\nseeds: [1, 2]\n");
    fs::create_directories(out());
    std::ofstream(out() / "sweep.yaml") << "a: 1\n";
    leave("recorded_fast_seed-1", "job.yaml", "");
    leave("recorded_fast_seed-2", "log.txt", "$ saccade run track\nsaccade: a notice\nworking\n");
    leave("recorded_accurate_seed-1", "log.txt", "$ saccade run track\nsaccade: a: is <no> key\n");
  }

  void leave(const std::string& job, const char* file, const char* text) const {
    fs::create_directories(out() / "jobs" / job);
    std::ofstream(out() / "jobs" / job / file) << text;
  }
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }

  TemporaryFolder folder_;
  SweepConfig sweep_;
};

TEST_F(Status, IsToldFromFilesAlone) {
  const SweepStatus status = sweep_status(sweep_, out());
  EXPECT_EQ(status.jobs.done, 1U);
  EXPECT_EQ(status.jobs.running, 1U);
  EXPECT_EQ(status.jobs.failed, 1U);
  EXPECT_EQ(status.jobs.waiting, 1U);
  ASSERT_EQ(status.parts.size(), 2U);
  EXPECT_EQ(status.parts[0].first, "fast");
  EXPECT_EQ(status.parts[0].second.done, 1U);
  EXPECT_FALSE(status.has_ended());
  EXPECT_THAT(status_text(status), HasSubstr("4 jobs: 1 done, 1 running, 1 failed, 1 waiting\n"));
  EXPECT_THAT(status_text(status), HasSubstr("failed: recorded_accurate_seed-1: a: is <no> key"));
}

TEST_F(Status, AsAPageItIsLoadedAgainUntilTheEnd) {
  const std::string page = status_page(sweep_status(sweep_, out()), sweep_.title, false);
  EXPECT_THAT(page, HasSubstr("http-equiv=\"refresh\""));
  EXPECT_THAT(page, HasSubstr("accurate: 0 of 2, 1 failed"));
  EXPECT_THAT(page, HasSubstr("jobs/recorded_accurate_seed-1/log.txt"));
  EXPECT_THAT(page, Not(HasSubstr("<no>")));
  EXPECT_THAT(page, Not(HasSubstr("<b>sweep")));
  EXPECT_THAT(testing::external_references(page), ::testing::IsEmpty());
  leave("recorded_fast_seed-2", "job.yaml", "");
  leave("recorded_accurate_seed-2", "job.yaml", "");
  EXPECT_THAT(status_page(sweep_status(sweep_, out()), "Sweep", true),
              Not(HasSubstr("http-equiv=\"refresh\"")));
}

TEST_F(Status, KnowsWhatWasKilledAndWhatIsHeld) {
  SweepPlan plan = plan_sweep(sweep_, out());
  // Killed in the middle: its log says nothing of it.
  SweepJob& killed = plan.runs[1];
  killed.failure = "failed: killed by signal 9 (Killed)";
  mark_failed(out(), killed);
  plan.runs[3].state = JobState::kHeld;
  mark_held(out(), plan);
  const SweepStatus status = sweep_status(sweep_, out());
  EXPECT_EQ(status.jobs.failed, 2U);
  EXPECT_EQ(status.jobs.all(), 3U);
  EXPECT_TRUE(status.has_ended());
  EXPECT_THAT(status_text(status), HasSubstr("killed by signal 9"));
  killed.failure.clear();
  mark_failed(out(), killed);
  mark_held(out(), {});
  EXPECT_EQ(sweep_status(sweep_, out()).jobs.running, 1U);
  EXPECT_EQ(sweep_status(sweep_, out()).jobs.waiting, 1U);
}

TEST_F(Status, OfAnotherFolderIsAnError) {
  EXPECT_THAT(
      testing::error_of([&] { static_cast<void>(sweep_status(sweep_, folder_.path() / "none")); }),
      HasSubstr("holds no sweep"));
}

}  // namespace
}  // namespace saccade
