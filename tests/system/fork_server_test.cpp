// Commands of `saccade` that a fork server starts for a sweep.

#include "core/process/fork_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/child_end.h"
#include "tests/support/error_of.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

/// Those that wait in vain for the other end of a pipe live until they are stopped.
class ForkServing : public ::testing::Test {
 protected:
  void SetUp() override {
    fifo_ = folder_.path() / "never.yaml";
    ASSERT_EQ(run_command("/usr/bin/mkfifo", {fifo_}).exit_code, 0);
  }

  ChildProcess start(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"saccade"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return server_.start(words, log_);
  }
  ChildProcess start_endless() { return start({"sweep", fifo_, "-o", folder_.path() / "sweep"}); }
  [[nodiscard]] std::string log() const { return read_file(log_); }
  [[nodiscard]] static bool is_alive(pid_t process) { return ::kill(process, 0) == 0; }
  /// The processes below one.
  [[nodiscard]] static std::vector<pid_t> children_of(pid_t process) {
    const std::string id = std::to_string(process);
    std::ifstream stream("/proc/" + id + "/task/" + id + "/children");
    std::vector<pid_t> children;
    for (pid_t child = 0; stream >> child;) children.push_back(child);
    return children;
  }

  TemporaryFolder folder_;
  std::filesystem::path fifo_;
  std::filesystem::path log_ = folder_.path() / "log.txt";
  ForkServer server_{SACCADE_COMMAND};
};

TEST_F(ForkServing, CommandsPrintAndEndAsIfStartedAlone) {
  ChildProcess good = start({"--version"});
  EXPECT_EQ(end_of(good).exit_code, 0);
  const std::string line = "$ saccade --version\n";
  EXPECT_EQ(log(), line + saccade({"--version"}).output);
  ChildProcess bad = start({"info", folder_.path() / "nothing here"});
  const ChildEnd end = end_of(bad);
  EXPECT_EQ(end.exit_code, 2);
  EXPECT_GT(end.peak_memory_mb, 0);
  EXPECT_GT(end.cpu_s, 0);
  EXPECT_THAT(log(), HasSubstr("$ saccade info '" + (folder_.path() / "nothing here").string()));
  EXPECT_THAT(log(), HasSubstr("nothing here"));
}

TEST_F(ForkServing, EndsAreThoseOfTheirOwn) {
  ChildProcess endless = start_endless();
  ChildProcess bad = start({"no_such_verb"});
  ChildProcess good = start({"--version"});
  EXPECT_EQ(end_of(good).exit_code, 0);
  EXPECT_EQ(end_of(bad).exit_code, 2);
  EXPECT_FALSE(endless.poll_end());
}

TEST_F(ForkServing, ACommandIsStoppedAndSaysSo) {
  ChildProcess endless = start_endless();
  while (endless.memory_mb() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until it listens to signals
  endless.stop();
  EXPECT_EQ(end_of(endless).exit_code, 128 + SIGTERM);
  EXPECT_THAT(log(), HasSubstr("saccade: interrupted (SIGTERM)"));
  EXPECT_EQ(endless.memory_mb(), 0);
}

TEST_F(ForkServing, NothingOutlivesItsHandle) {
  std::vector<pid_t> left;
  {
    const ChildProcess endless = start_endless();
    const std::vector<pid_t> servers = children_of(::getpid());
    ASSERT_EQ(servers.size(), 1U);
    left = children_of(servers.front());
    ASSERT_EQ(left.size(), 1U);
  }
  for (int i = 0; i < 2000 && is_alive(left.front()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(is_alive(left.front()));
}

TEST_F(ForkServing, ASignalToAllEndsTheCommandsInGoodOrder) {
  ChildProcess endless = start_endless();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until it listens to signals
  const std::vector<pid_t> servers = children_of(::getpid());
  ASSERT_EQ(servers.size(), 1U);
  ::kill(servers.front(), SIGTERM);
  endless.stop();
  EXPECT_EQ(end_of(endless).exit_code, 128 + SIGTERM);
  EXPECT_THAT(log(), HasSubstr("saccade: interrupted (SIGTERM)"));
  ChildProcess next = start({"--version"});
  EXPECT_EQ(end_of(next).exit_code, 0);
}

TEST_F(ForkServing, AServerThatDiesTakesItsCommandsAlong) {
  ChildProcess endless = start_endless();
  const std::vector<pid_t> servers = children_of(::getpid());
  ASSERT_EQ(servers.size(), 1U);
  const std::vector<pid_t> commands = children_of(servers.front());
  ASSERT_EQ(commands.size(), 1U);
  ::kill(servers.front(), SIGKILL);
  EXPECT_EQ(end_of(endless).signal, SIGKILL);
  for (int i = 0; i < 2000 && is_alive(commands.front()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(is_alive(commands.front()));
  EXPECT_THAT(error_of([&] { return start({"--version"}).descriptor(); }),
              StartsWith("a process of its own: cannot be started"));
}

TEST_F(ForkServing, ALogThatCannotBeWrittenIsRefused) {
  log_ = folder_.path() / "no folder" / "log.txt";
  EXPECT_THAT(error_of([&] { return start({"--version"}).descriptor(); }), HasSubstr("no folder"));
}

TEST_F(ForkServing, WordsMayBeManyAndEmpty) {
  std::vector<std::string> words{"info", folder_.path() / "nothing", "--quiet", ""};
  words.resize(5000, std::string(100, 'x'));
  ChildProcess many = start(words);
  EXPECT_EQ(end_of(many).exit_code, 2);
}

TEST(ForkServer, IsNoVerb) {
  const CommandResult result = saccade({"fork-server"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, MatchesRegex("saccade: fork-server is .*; there is no such verb\n"));
}

TEST(ForkServer, AProgramThatIsNotThereCannotBeStarted) {
  EXPECT_THAT(error_of([] {
                return ForkServer("/no/such/program").start({"saccade"}, "log").descriptor();
              }),
              StartsWith("a process of its own: cannot be started"));
}

}  // namespace
}  // namespace saccade::testing
