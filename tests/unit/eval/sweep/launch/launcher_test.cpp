#include "eval/sweep/launch/launcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <thread>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using testing::TemporaryFolder;

/// Jobs whose calls are scripts of the shell.
class Launching : public ::testing::Test {
 protected:
  void add(const std::string& name, const std::vector<std::string>& scripts) {
    LaunchJob job{name, {}, folder_.path() / name / "log.txt", {}};
    for (const std::string& script : scripts) job.commands.push_back({"-c", script});
    jobs_.push_back(job);
  }

  bool run(
      int parallel_jobs, const std::function<void()>& on_wait = [] {}) {
    const auto on_end = [&](std::size_t i, const LaunchResult& result) {
      results_[jobs_[i].name] = result;
    };
    return make_launcher("local", {"/bin/sh", {}, {}, false})
        ->run(jobs_, {parallel_jobs, 1}, {on_end, on_wait, [](const std::string&) {}});
  }

  [[nodiscard]] std::string log(const std::string& name) const {
    return read_file(folder_.path() / name / "log.txt");
  }

  TemporaryFolder folder_;
  std::vector<LaunchJob> jobs_;
  std::map<std::string, LaunchResult> results_;
};

TEST_F(Launching, LogsWhatTheCallsPrintInTurn) {
  add("a", {"echo one; echo two >&2", "echo three"});
  EXPECT_TRUE(run(1));
  EXPECT_TRUE(results_.at("a").succeeded);
  EXPECT_EQ(log("a"),
            "$ saccade -c 'echo one; echo two >&2'\none\ntwo\n$ saccade -c 'echo three'\nthree\n");
}

TEST_F(Launching, AFailureEndsItsJobAndNoOther) {
  add("a", {"exit 3", "echo never"});
  add("b", {"kill -9 $$"});
  add("c", {"true"});
  EXPECT_TRUE(run(2));
  EXPECT_FALSE(results_.at("a").succeeded);
  EXPECT_EQ(results_.at("a").problem, "exit code 3");
  EXPECT_EQ(results_.at("a").failed, jobs_[0].commands[0]);
  EXPECT_THAT(log("a"), ::testing::Not(HasSubstr("never")));
  EXPECT_THAT(results_.at("b").problem, HasSubstr("signal 9"));
  EXPECT_TRUE(results_.at("c").succeeded);
}

TEST_F(Launching, RunsAsManyAtOnceAsAllowed) {
  // Each waits for the other; a single one would wait in vain.
  const std::string meet = (folder_.path() / "meet").string();
  ASSERT_EQ(testing::run_command("/usr/bin/mkfifo", {meet}).exit_code, 0);
  add("reads", {"read line < " + meet + " && test $line = hello"});
  add("writes", {"echo hello > " + meet});
  EXPECT_TRUE(run(2));
  EXPECT_TRUE(results_.at("reads").succeeded);
  EXPECT_TRUE(results_.at("writes").succeeded);
}

TEST_F(Launching, NeverRunsMoreAtOnceThanAllowed) {
  // A job counts those that run with it by the folders that each makes and removes.
  const std::string here = (folder_.path() / "running").string();
  std::filesystem::create_directory(here);
  for (int i = 0; i < 12; ++i)
    add(std::to_string(i),
        {"mkdir " + here + "/$$; sleep 0.02; ls " + here + " | wc -l; rmdir " + here + "/$$"});
  EXPECT_TRUE(run(3));
  for (const LaunchJob& job : jobs_) {
    const std::string text = log(job.name);
    EXPECT_LE(std::stoi(text.substr(text.find('\n') + 1)), 3) << text;
  }
}

TEST(LocalLauncher, JobsTimesThreadsNeverExceedTheCores) {
  const auto launcher = make_launcher("local");
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  for (int threads = 1; threads <= cores; ++threads) {
    const int parallel_jobs = launcher->default_parallel_jobs(threads);
    EXPECT_LE(parallel_jobs * threads, cores);
    EXPECT_GT((parallel_jobs + 1) * threads, cores) << "cores are left idle";
  }
  EXPECT_EQ(launcher->default_parallel_jobs(0), 1);
  EXPECT_EQ(launcher->default_parallel_jobs(cores + 1), 1) << "one job must run all the same";
}

TEST_F(Launching, OneAtATimeKeepsTheOrder) {
  const std::string file = (folder_.path() / "order").string();
  for (const char* name : {"1", "2", "3"})
    add(name, {"echo begin " + std::string(name) + " >> " + file,
               "echo end " + std::string(name) + " >> " + file});
  EXPECT_TRUE(run(1));
  EXPECT_EQ(read_file(file), "begin 1\nend 1\nbegin 2\nend 2\nbegin 3\nend 3\n");
}

TEST_F(Launching, AnInterruptStopsTheChildren) {
  // Whoever was started in the background of a script ignores it.
  std::signal(SIGINT, SIG_DFL);
  add("a", {"echo $$ > " + (folder_.path() / "pid").string() + "; sleep 1000 & wait"});
  add("b", {"true"});
  EXPECT_FALSE(run(1, [&] {
    if (std::filesystem::exists(folder_.path() / "pid")) std::raise(SIGINT);
  }));
  EXPECT_TRUE(results_.empty());
  EXPECT_NE(::kill(std::stoi(read_file(folder_.path() / "pid")), 0), 0) << "it is still there";
}

TEST(Launcher, NamesTheValidOnes) {
  EXPECT_EQ(testing::error_of([] { return make_launcher("cloud") == nullptr; }),
            "--launcher: there is no launcher 'cloud'; valid launchers: local, slurm");
}

}  // namespace
}  // namespace saccade
