#include "core/stopwatch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace saccade {
namespace {

TEST(Stopwatch, CountsTheSecondsSinceItWasMade) {
  const Stopwatch watch;
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const double first_s = watch.seconds();
  EXPECT_GE(first_s, 0.005);
  EXPECT_GE(watch.seconds(), first_s);
}

TEST(ScopedTimer, AddsItsLifetimeToTheSum) {
  double sum_s = 1;
  {
    const ScopedTimer timer(sum_s);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(sum_s, 1);
  }
  EXPECT_GE(sum_s, 1.005);
}

}  // namespace
}  // namespace saccade
