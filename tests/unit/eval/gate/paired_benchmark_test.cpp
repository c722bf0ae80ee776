#include "eval/gate/paired_benchmark.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"

namespace saccade {
namespace {

using testing::TemporaryFolder;

std::filesystem::path write_program(const TemporaryFolder& folder, const std::string& name,
                                    const std::string& script) {
  const auto file = folder.write(name, "#!/bin/sh\n" + script);
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  return file;
}

TEST(RepetitionOrder, LeadsAlternatelyAfterAWarmUpOfEach) {
  std::string order;
  for (const Repetition& repetition : repetition_order(4))
    order += repetition.timed ? (repetition.second ? 'B' : 'A') : (repetition.second ? 'b' : 'a');
  EXPECT_EQ(order, "abABBAABBA");
}

TEST(PairedBenchmark, ReadsTheTimeOfARunFromItsTimingFile) {
  const TemporaryFolder folder;
  const auto writes = [&](const std::string& name, const std::string& wall_s) {
    return write_program(
        folder, name, "echo '{\"wall_s\": {\"median\": " + wall_s + "}}' > \"$3/timing.json\"\n");
  };
  const PairedBenchmark benchmark{
      writes("a", "2.5"), writes("b", "3"), {"run", "-o", folder.path().string()}, 2};
  const PairedTimes times = run_paired_benchmark(benchmark, [](const Repetition&) {});
  EXPECT_THAT(times.first_s, ::testing::ElementsAre(2.5, 2.5));
  EXPECT_THAT(times.second_s, ::testing::ElementsAre(3, 3));
}

TEST(PairedBenchmark, TimesAnyProgram) {
  const TemporaryFolder folder;
  const auto program = write_program(folder, "a", "exit 0\n");
  int repetitions = 0;
  const PairedTimes times = run_paired_benchmark({program, program, {"info"}, 3},
                                                 [&](const Repetition&) { ++repetitions; });
  EXPECT_EQ(repetitions, 8);
  ASSERT_EQ(times.first_s.size(), 3U);
  for (const double wall_s : times.second_s) EXPECT_GT(wall_s, 0);
}

TEST(PairedBenchmark, AProgramThatFailsEndsIt) {
  const TemporaryFolder folder;
  const auto good = write_program(folder, "good", "exit 0\n");
  const auto bad = write_program(folder, "bad", "echo no such scene\nexit 2\n");
  try {
    (void)run_paired_benchmark({good, bad, {"info"}, 2}, [](const Repetition&) {});
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr("bad ended with exit code 2"),
                                               ::testing::HasSubstr("no such scene")));
  }
}

}  // namespace
}  // namespace saccade
