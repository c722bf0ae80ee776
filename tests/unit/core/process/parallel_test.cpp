#include "core/process/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace saccade {
namespace {

class Parallel : public ::testing::Test {
 protected:
  void TearDown() override { set_thread_count(0); }
};

TEST_F(Parallel, VisitsEveryIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    EXPECT_EQ(thread_count(), threads);
    std::vector<std::atomic<int>> visits(1000);
    parallel_for(
        visits.size(), [&](std::size_t i) { ++visits[i]; }, 7);
    for (const std::atomic<int>& v : visits) ASSERT_EQ(v, 1);
  }
}

TEST_F(Parallel, RangesDoNotDependOnTheThreads) {
  const auto ranges = [](int threads) {
    set_thread_count(threads);
    std::mutex mutex;
    std::set<std::pair<std::size_t, std::size_t>> seen;
    parallel_for_ranges(103, 10, [&](std::size_t begin, std::size_t end) {
      const std::scoped_lock lock(mutex);
      seen.emplace(begin, end);
    });
    return seen;
  };
  EXPECT_EQ(ranges(1).size(), 11U);
  EXPECT_EQ(ranges(1), ranges(4));
}

TEST_F(Parallel, MoreThreadsThanCoresAreReal) {
  set_thread_count(4);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::atomic<int> waiting{0};
  // Each body waits for the others, so that no thread can take two.
  parallel_for(4, [&](std::size_t) {
    ++waiting;
    for (int i = 0; i < 5000 && waiting < 4; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::scoped_lock lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads.size(), 4U);
}

TEST_F(Parallel, MayBeNested) {
  set_thread_count(3);
  std::atomic<int> count{0};
  parallel_for(10, [&](std::size_t) { parallel_for(10, [&](std::size_t) { ++count; }); });
  EXPECT_EQ(count, 100);
}

TEST_F(Parallel, RethrowsAndHandlesNothing) {
  set_thread_count(2);
  EXPECT_THROW(parallel_for(100,
                            [](std::size_t i) {
                              if (i == 50) throw std::runtime_error("50");
                            }),
               std::runtime_error);
  parallel_for(0, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace saccade
