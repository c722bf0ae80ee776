#include "core/process/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <poll.h>

#include <vector>

#include "tests/support/child_end.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::end_of;
using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

TEST(ChildProcess, SaysHowItEndedAndWhatItTook) {
  const TemporaryFolder folder;
  const std::string log = folder.path() / "log";
  ChildProcess process(
      "sh", {"sh", "-c", "i=0; while [ $i -lt 20000 ]; do i=$((i+1)); done; exit 3"}, log);
  const ChildEnd end = end_of(process);
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.text(), "exit code 3");
  EXPECT_GT(end.cpu_s, 0);
  EXPECT_GT(end.peak_memory_mb, 0);
}

TEST(ChildProcess, TellsItsMemoryAlone) {
  const TemporaryFolder folder;
  std::vector<char> large(200 << 20, 'x');
  ChildProcess process("sh", {"sh", "-c", "sleep 60; true"}, folder.path() / "log");
  double memory_mb = 0;
  for (int i = 0; i < 1000 && memory_mb == 0; ++i) {
    memory_mb = process.memory_mb();
    ::poll(nullptr, 0, 5);
  }
  ASSERT_EQ(large[1 << 20], 'x');
  EXPECT_GT(memory_mb, 0);
  EXPECT_LT(memory_mb, 100);
  process.stop();
  EXPECT_EQ(end_of(process).signal, 15);
  EXPECT_EQ(process.memory_mb(), 0);
}

TEST(ChildProcess, GetsItsFolderAndTheEnvironment) {
  const TemporaryFolder folder;
  const std::string log = folder.path() / "log";
  ChildProcess process("env",
                       {"env", "COLOUR=green", "sh", "-c", "pwd; echo $COLOUR; test -n \"$PATH\""},
                       log, folder.path());
  EXPECT_EQ(end_of(process).exit_code, 0);
  EXPECT_THAT(read_file(log), HasSubstr("\n" + folder.path().string() + "\ngreen\n"));
}

TEST(ChildProcess, WhatIsNotThereCannotBeStarted) {
  const TemporaryFolder folder;
  EXPECT_THAT(testing::error_of([&] {
                ChildProcess process("no_such_program", {"no_such_program"}, folder.path() / "log");
                return process.descriptor();
              }),
              HasSubstr("no_such_program: cannot be started"));
}

}  // namespace
}  // namespace saccade
