#include "core/process/background_task.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/process/parallel.h"

namespace saccade {
namespace {

class BackgroundTasks : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};

TEST_P(BackgroundTasks, AreDoneAfterWaiting) {
  BackgroundTask task;
  int sum = 0;
  for (int i = 1; i <= 100; ++i) {
    task.start([&sum, i] { sum += i; });
    task.wait();
  }
  EXPECT_EQ(sum, 5050);
  task.wait();  // for nothing
}

TEST_P(BackgroundTasks, MayWorkInParallelThemselves) {
  BackgroundTask task;
  std::vector<int> squares(1000);
  task.start([&] {
    parallel_for(squares.size(), [&](std::size_t i) { squares[i] = static_cast<int>(i * i); });
  });
  std::vector<int> cubes(100);
  parallel_for(cubes.size(), [&](std::size_t i) { cubes[i] = static_cast<int>(i * i * i); });
  task.wait();
  EXPECT_EQ(squares[999], 998001);
  EXPECT_EQ(cubes[99], 970299);
}

TEST_P(BackgroundTasks, AnErrorIsThrownByTheNextWait) {
  BackgroundTask task;
  task.start([] { throw std::runtime_error("disk"); });
  task.settle();
  EXPECT_THROW(task.wait(), std::runtime_error);
  task.wait();
  bool is_done = false;
  task.start([&] { is_done = true; });
  task.wait();
  EXPECT_TRUE(is_done);
}

/// A single thread has not begun what nobody waited for, and nobody wants it any more.
TEST_P(BackgroundTasks, TheDestructorWaitsForWhatHasBegun) {
  std::atomic<bool> is_done = false;
  {
    BackgroundTask task;
    task.start([&] { is_done = true; });
  }
  EXPECT_EQ(is_done, GetParam() > 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, BackgroundTasks, ::testing::Values(1, 2, 5));

TEST(BackgroundTask, ASingleThreadIsTheCallersOwn) {
  set_thread_count(1);
  BackgroundTask task;
  std::thread::id worker;
  task.start([&] { worker = std::this_thread::get_id(); });
  EXPECT_EQ(worker, std::thread::id());
  task.wait();
  EXPECT_EQ(worker, std::this_thread::get_id());
  set_thread_count(0);
}

/// As in a viewer or a program in Python. It does not show what loops that stay in the pool prevent:
/// without that it ended as well in thousands of repetitions.
TEST(BackgroundTask, OfSeveralThreadsOfAProgramEndsEach) {
  set_thread_count(2);
  std::atomic<int> done = 0;
  const auto use = [&] {
    BackgroundTask task;
    for (int i = 0; i < 300; ++i) {
      task.start([&] { parallel_for(40, [&](std::size_t) { ++done; }); });
      parallel_for(10, [&](std::size_t) { ++done; });
      task.wait();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(use);
  for (std::thread& thread : threads) thread.join();
  set_thread_count(0);
  EXPECT_EQ(done, 4 * 300 * 50);
}

}  // namespace
}  // namespace saccade
