#include "core/io/files/temporary_paths.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/io/files/atomic_file.h"
#include "core/process/interruption.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

TEST(TemporaryPaths, GoWithTheirObjects) {
  const TemporaryFolder folder;
  {
    const TemporaryPath path(folder.path() / "a");
    fs::create_directories(path.path() / "b");
    EXPECT_TRUE(fs::exists(path.path() / "b"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// What is left in a folder after a process that works there was ended by `signal`; its exit code.
int exit_code_after(int signal, const fs::path& folder) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    std::signal(signal, SIG_DFL);  // a shell ignores SIGINT for what it runs in the background
    end_on_interruption();
    const AtomicFile file(folder / "result.txt");
    std::ofstream(file.path()) << "a half";
    const AtomicFolder whole(folder / "run", "run.yaml");
    std::ofstream(whole.path() / "poses.txt") << "a half";
    kill(getpid(), signal);
    pause();
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(TemporaryPaths, GoWithAProgramThatASignalEnds) {
  // Not a TemporaryFolder: the process would know that one as well, and remove it.
  std::string name = (fs::temp_directory_path() / "signal_XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  EXPECT_EQ(exit_code_after(SIGINT, name), 130);
  EXPECT_TRUE(fs::is_empty(name));
  EXPECT_EQ(exit_code_after(SIGTERM, name), 143);
  EXPECT_TRUE(fs::is_empty(name));
  fs::remove_all(name);
}

TEST(TemporaryPaths, DoNotComeBackWhileASignalEndsTheProgram) {
  std::string name = (fs::temp_directory_path() / "signal_XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    end_on_interruption();
    std::vector<std::thread> writers;
    for (int i = 0; i < 3; ++i)
      writers.emplace_back([path = fs::path(name) / std::to_string(i)] {
        const TemporaryPath temporary(path);
        for (;;) {
          std::error_code ignored;
          fs::create_directory(path, ignored);
          std::ofstream(path / "file") << "a half";
        }
      });
    while (!fs::exists(fs::path(name) / "2" / "file")) std::this_thread::yield();
    kill(getpid(), SIGTERM);
    for (;;) pause();
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 143);
  EXPECT_TRUE(fs::is_empty(name));
  fs::remove_all(name);
}

}  // namespace
}  // namespace saccade
