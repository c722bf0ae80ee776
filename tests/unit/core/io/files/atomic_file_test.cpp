#include "core/io/files/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, ReplacesTheFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "deep" / "down" / "f.txt";
  write_atomically(file, "old");
  write_atomically(file, "new");
  EXPECT_EQ(read_file(file), "new");
  EXPECT_EQ(entries(file.parent_path()), 1U);
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("f.txt", "old");
  {
    const AtomicFile target(file);
    std::ofstream(target.path()) << "half";
    EXPECT_EQ(entries(folder.path()), 2U);
  }
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, NamesThePathThatCannotBeWritten) {
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THAT(error_of([&] { return write_atomically(folder.path() / "file" / "f", "x"), 0; }),
              HasSubstr("file/f: cannot create the folder"));
  EXPECT_THAT(error_of([&] { return write_atomically(folder.path(), "x"), 0; }),
              HasSubstr("is a folder"));
}

TEST(AtomicFile, FollowsLinksAndRefusesDevices) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("f.txt", "old");
  fs::create_symlink(file, folder.path() / "link");
  write_atomically(folder.path() / "link", "new");
  EXPECT_EQ(read_file(file), "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  // A pipe stands for every special file: a test must never be able to damage a real device.
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { return write_atomically(pipe, "x"), 0; }), HasSubstr("is a device"));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFolder, AppearsWhenCommitted) {
  const TemporaryFolder folder;
  const fs::path name = folder.path() / "out";
  AtomicFolder target(name.string() + "/", "run.yaml");
  write_atomically(target.path() / "run.yaml", "a: 1\n");
  EXPECT_FALSE(fs::exists(name));
  EXPECT_EQ(target.path().filename().string().rfind(".out.partial-", 0), 0U);
  target.commit();
  EXPECT_EQ(read_file(name / "run.yaml"), "a: 1\n");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFolder, WithoutCommitNothingIsLeft) {
  const TemporaryFolder folder;
  {
    const AtomicFolder target(folder.path() / "out", "run.yaml");
    write_atomically(target.path() / "run.yaml", "a: 1\n");
  }
  EXPECT_EQ(entries(folder.path()), 0U);
}

TEST(AtomicFolder, SaysThatItWasTakenAway) {
  const TemporaryFolder folder;
  {
    AtomicFolder target(folder.path() / "out", "run.yaml");
    write_atomically(target.path() / "run.yaml", "a: 1\n");
    fs::remove_all(target.path());
    write_atomically(target.path() / "late", "x");
    EXPECT_THAT(error_of([&] { return target.commit(), 0; }),
                HasSubstr("was removed by someone else"));
  }
  EXPECT_EQ(entries(folder.path()), 0U);
}

TEST(AtomicFolder, ReplacesItsOwnKindAndEmptyFolders) {
  const TemporaryFolder folder;
  folder.write("own/run.yaml", "old");
  folder.write("own/more", "old");
  fs::create_directory(folder.path() / "empty");
  for (const char* name : {"own", "empty"}) {
    AtomicFolder target(folder.path() / name, "run.yaml");
    write_atomically(target.path() / "run.yaml", "new");
    target.commit();
    EXPECT_EQ(read_file(folder.path() / name / "run.yaml"), "new");
    EXPECT_EQ(entries(folder.path() / name), 1U);
  }
  EXPECT_EQ(entries(folder.path()), 2U);
}

TEST(AtomicFolder, LeavesForeignFoldersAlone) {
  const TemporaryFolder folder;
  folder.write("home/thesis.tex", "precious");
  EXPECT_THAT(error_of([&] { return AtomicFolder(folder.path() / "home", "run.yaml"), 0; }),
              HasSubstr("home: exists and holds other files (no run.yaml"));
  EXPECT_THAT(
      error_of([&] { return AtomicFolder(folder.path() / "home/thesis.tex", "run.yaml"), 0; }),
      HasSubstr("exists and is no folder"));
  EXPECT_EQ(read_file(folder.path() / "home/thesis.tex"), "precious");
}

/// A process that begins a file and a folder in `folder`; it lives until it is killed.
class Writer {
 public:
  explicit Writer(const fs::path& folder) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      const AtomicFile file(folder / "f.txt");
      const AtomicFolder run(folder / "r", "run.yaml");
      std::ofstream(run.path() / "run.yaml") << "half";
      [[maybe_unused]] const auto told = ::write(ends[1], "", 1);
      for (;;) pause();
    }
    char begun = 0;
    EXPECT_EQ(read(ends[0], &begun, 1), 1);
    for (const int end : ends) close(end);
  }
  ~Writer() { end(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void end() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  pid_t process_ = 0;
};

TEST(AtomicFile, WhatAKilledProcessLeftGoesWithTheNextOne) {
  const TemporaryFolder folder;
  Writer writer(folder.path());
  writer.end();
  EXPECT_EQ(entries(folder.path()), 2U);
  write_atomically(folder.path() / "other.txt", "new");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, WhatAnotherProcessStillWritesStays) {
  const TemporaryFolder folder;
  const Writer writer(folder.path());
  write_atomically(folder.path() / "f.txt", "new");
  EXPECT_EQ(entries(folder.path()), 3U);
}

TEST(AtomicFile, WhatNobodyHereCanJudgeStays) {
  const TemporaryFolder folder;
  // No process has this number, but the first is of another machine, and the others are a user's.
  for (const char* name : {".f.partial-0123456789abcdef.2147483646-0", ".f.partial-2147483646-0",
                           ".f.partial-", "-", ".-"})
    folder.write(name, "theirs");
  write_atomically(folder.path() / "f", "new");
  EXPECT_EQ(entries(folder.path()), 6U);
}

}  // namespace
}  // namespace saccade
