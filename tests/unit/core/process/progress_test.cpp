#include "core/process/progress.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/process/progress_observer.h"

namespace saccade {
namespace {

TEST(Progress, TextHoldsShareRateAndTimeLeft) {
  EXPECT_EQ(progress_text({"tracking", "events", 250'000, 1'000'000, 0.5, false, false}),
            "tracking:  25 %, 500 k events/s, 1.5 s left");
  EXPECT_EQ(progress_text({"tracking", "events", 500, 1000, 0.5, true, false}),
            "tracking: [############............]  50 %, 1 k events/s, 0.5 s left");
  EXPECT_EQ(progress_text({"reading", "events", 1'234'567, 0, 2, false, false}),
            "reading: 1.23 M events, 617 k events/s");
  EXPECT_EQ(progress_text({"reading", "events", 0, 10, 0, false, false}),
            "reading:   0 %, 0 events/s");
  EXPECT_EQ(progress_text({"a", "poses", 10, 10, 4000, false, true}),
            "a: 10 poses in 1 h 06 min, 0.0025 poses/s");
}

TEST(Progress, LogsHoldOneLineForShortWork) {
  set_progress_quiet(false);  // whatever ran before in this process
  ::testing::internal::CaptureStderr();
  {
    Progress progress("work", 4000, "steps");
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) progress.add(1);
      });
    for (std::thread& thread : threads) thread.join();
    progress.finish();
  }
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.rfind("work: 4 k steps in ", 0), 0U) << log;
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1);
}

TEST(Progress, ReportsWhatWentWrongQuietOrNot) {
  set_progress_quiet(true);
  ::testing::internal::CaptureStderr();
  { Progress("work", 10, "steps").report("step 3 failed"); }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "step 3 failed\n");
  set_progress_quiet(false);
}

TEST(Progress, AnObserverFollowsEveryStepAndMayEndTheWork) {
  set_progress_quiet(true);
  std::vector<std::uint64_t> seen;
  set_progress_observer([&](const ProgressState& state) {
    EXPECT_EQ(state.label, "work");
    EXPECT_EQ(state.total, 10U);
    seen.push_back(state.done);
    if (state.done >= 7) throw std::runtime_error("enough");
  });
  Progress progress("work", 10, "steps");
  progress.add(3);
  EXPECT_THROW(progress.add(4), std::runtime_error);
  set_progress_observer({});
  progress.add(1);
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{3, 7}));
  set_progress_quiet(false);
}

TEST(Progress, QuietShowsNothing) {
  set_progress_quiet(true);
  ::testing::internal::CaptureStderr();
  { Progress("work", 10, "steps").add(10); }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  set_progress_quiet(false);
}

}  // namespace
}  // namespace saccade
