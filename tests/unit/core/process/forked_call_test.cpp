#include "core/process/forked_call.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace saccade {
namespace {

using ::testing::HasSubstr;

TEST(ForkedCall, GivesBackItsBytes) {
  std::string bytes(3'000'000, 'x');
  bytes[1'234'567] = '\0';
  const ForkedResult result = call_in_child([&] { return bytes; });
  EXPECT_EQ(result.problem, "");
  EXPECT_TRUE(result.bytes == bytes);
}

TEST(ForkedCall, ChangesNothingHere) {
  int number = 1;
  static_cast<void>(call_in_child([&] {
    number = 2;
    return std::string();
  }));
  EXPECT_EQ(number, 1);
}

TEST(ForkedCall, ExceptionsBecomeWords) {
  const ForkedResult result =
      call_in_child([]() -> std::string { throw std::runtime_error("no such thing"); });
  EXPECT_EQ(result.problem, "no such thing");
  EXPECT_FALSE(result.died);
}

TEST(ForkedCall, CrashesBecomeWords) {
  const ForkedResult aborted = call_in_child([]() -> std::string { std::abort(); });
  EXPECT_TRUE(aborted.died);
  EXPECT_THAT(aborted.problem, HasSubstr("Aborted"));
  const ForkedResult ended = call_in_child([]() -> std::string { std::_Exit(3); });
  EXPECT_TRUE(ended.died);
  EXPECT_THAT(ended.problem, HasSubstr("exit code 3"));
}

TEST(ForkedCall, HangsEnd) {
  ForkLimits limits;
  limits.cpu_s = 1;
  const ForkedResult busy = call_in_child(
      []() -> std::string {
        for (std::atomic<int> turns = 0;; ++turns) {
        }
      },
      limits);
  EXPECT_TRUE(busy.died);
  EXPECT_EQ(busy.problem, "took more than 1 s");
  limits.wall_s = 0.05;
  const ForkedResult idle = call_in_child(
      []() -> std::string {
        for (;;) pause();
      },
      limits);
  EXPECT_TRUE(idle.died);
  EXPECT_EQ(idle.problem, "took more than 0.05 s");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ForkedCall, MemoryIsLimited) {
  ForkLimits limits;
  limits.memory_mb = 64;
  const ForkedResult result = call_in_child(
      [] { return std::string(std::vector<char>(std::size_t{1} << 30U).size() / 2, 'x'); }, limits);
  EXPECT_EQ(result.problem, "takes more than 64 MB of memory");
  EXPECT_FALSE(result.died);
}
#endif

TEST(ForkedWorker, KeepsWhatItHasBetweenCalls) {
  int calls = 0;
  ForkedWorker worker([&](const std::string& text) { return text + std::to_string(++calls); });
  EXPECT_EQ(worker.call("a").bytes, "a1");
  EXPECT_EQ(worker.call("b").bytes, "b2");
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(worker.call(std::string(3'000'000, 'x')).bytes.size(), 3'000'001U);
}

TEST(ForkedWorker, IsReplacedWhenItDied) {
  int calls = 0;
  ForkedWorker worker([&](const std::string& text) {
    if (text == "die") std::abort();
    if (text == "fail") throw std::runtime_error("no such thing");
    return std::to_string(++calls);
  });
  EXPECT_EQ(worker.call("").bytes, "1");
  EXPECT_EQ(worker.call("fail").problem, "no such thing");
  EXPECT_EQ(worker.call("").bytes, "2");
  EXPECT_TRUE(worker.call("die").died);
  EXPECT_EQ(worker.call("").bytes, "1");
}

TEST(ForkedWorker, TheLimitsAreThoseOfACall) {
  ForkLimits limits;
  limits.cpu_s = 1;
  ForkedWorker worker(
      [](const std::string& seconds) {
        const std::clock_t end =
            std::clock() + static_cast<std::clock_t>(std::stod(seconds) * CLOCKS_PER_SEC);
        while (std::clock() < end) {
        }
        return seconds;
      },
      limits);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(worker.call("0.6").bytes, "0.6");
  EXPECT_EQ(worker.call("9").problem, "took more than 1 s");
}

TEST(ForkedWorker, StopsFromAnotherThread) {
  ForkedWorker worker([](const std::string&) -> std::string {
    for (;;) pause();
  });
  std::thread other([&] { worker.stop(); });
  EXPECT_TRUE(worker.call("").died);
  other.join();
  EXPECT_EQ(worker.call("").problem, "was stopped");
}

}  // namespace
}  // namespace saccade
