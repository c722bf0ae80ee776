#include "core/process/memory_limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

TEST(MemoryLimit, IsThatOfTheMachineOrLess) {
  const std::uint64_t limit = memory_limit_bytes();
  EXPECT_GT(limit, std::uint64_t{1} << 24U);
  EXPECT_LE(limit, static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                       static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

TEST(MemoryLimit, KnowsTheLimitOfTheAddressSpace) {
  constexpr rlim_t kLimit = rlim_t{1} << 40U;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit half{memory_limit_bytes() / 2, kLimit};
    _exit(setrlimit(RLIMIT_AS, &half) == 0 && memory_limit_bytes() == half.rlim_cur ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(MemoryLimit, ErrorsSayWhatToLower) {
  EXPECT_EQ(error_of([] {
              check_memory(1e6, "a.yaml:3", "A sensor", "lower its size");
              return 0;
            }),
            "no error");
  const std::string error = error_of([] {
    check_memory(1e18, "a.yaml:3", "A sensor", "lower its size");
    return 0;
  });
  EXPECT_THAT(error, HasSubstr("a.yaml:3: A sensor takes about 1e+09 GB"));
  EXPECT_THAT(error, HasSubstr("lower its size"));
}

}  // namespace
}  // namespace saccade
