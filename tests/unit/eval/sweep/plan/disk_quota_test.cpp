#include "eval/sweep/plan/disk_quota.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/command.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;

class Quota : public ::testing::Test {
 protected:
  Quota() {
    for (int i = 0; i < 100; ++i) {
      SweepJob job;
      job.output = folder_.path() / std::to_string(i);
      jobs_.push_back(job);
    }
  }

  /// Makes what was released, each of `bytes`; how many.
  std::size_t make(std::size_t bytes) {
    std::size_t made = 0;
    for (SweepJob& job : jobs_) {
      if (job.state != JobState::kPending) continue;
      std::filesystem::create_directories(job.output / "images");
      std::ofstream(job.output / "images" / "a") << std::string(bytes, 'x');
      job.state = JobState::kDone;
      ++made;
    }
    return made;
  }
  [[nodiscard]] std::size_t done() const {
    return static_cast<std::size_t>(
        std::count_if(jobs_.begin(), jobs_.end(),
                      [](const SweepJob& job) { return job.state == JobState::kDone; }));
  }

  testing::TemporaryFolder folder_;
  std::vector<SweepJob> jobs_;
};

TEST_F(Quota, MakesWhatFits) {
  DiskQuota quota(50e3 / 1e9, jobs_);
  EXPECT_EQ(make(1000), 2U);
  while (quota.release_next()) make(1000);
  EXPECT_GE(done(), 40U);
  EXPECT_LE(done(), 50U) << "not more than the space holds";
  EXPECT_THAT(quota.message(), HasSubstr("of 100 datasets were made"));
}

TEST_F(Quota, MakesAllWhereThereIsRoom) {
  DiskQuota quota(1, jobs_);
  do make(1000);
  while (quota.release_next());
  EXPECT_EQ(done(), 100U);
  EXPECT_EQ(quota.message(), "");
}

TEST_F(Quota, SaysWhereItTakesMore) {
  DiskQuota quota(500 / 1e9, jobs_);
  make(1000);
  EXPECT_FALSE(quota.release_next());
  EXPECT_THAT(quota.message(), HasSubstr("2 datasets take"));
}

TEST_F(Quota, EndsWhereNothingCanBeMade) {
  DiskQuota quota(1, jobs_);
  for (SweepJob& job : jobs_)
    if (job.state == JobState::kPending) job.state = JobState::kFailed;
  EXPECT_FALSE(quota.release_next());
}

}  // namespace
}  // namespace saccade
