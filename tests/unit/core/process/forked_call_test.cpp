#include "core/process/forked_call.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
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

}  // namespace
}  // namespace saccade
