#include "eval/sweep/launch/slurm_launcher.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <map>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::read_file;
using testing::TemporaryFolder;

/// A cluster that runs every task at once when it is submitted, except those of arrays for which
/// another end was ordered.
class FakeCluster : public SlurmCluster {
 public:
  void check() override {}
  [[nodiscard]] int max_array_size() override { return 1001; }

  [[nodiscard]] std::string submit(const std::filesystem::path& script,
                                   const std::vector<std::string>& options) override {
    if (!refusal.empty()) return refusal;
    submitted.push_back(options);
    const std::string name = options.at(0).substr(options.at(0).find('=') + 1);
    arrays.push_back(name);
    const int last = std::stoi(options.at(1).substr(std::string("--array=0-").size()));
    for (int task = 0; task <= last; ++task) {
      std::string& state = states[name + "|" + std::to_string(task)];
      state = "COMPLETED";
      if (!orders.empty()) {
        state = orders.front();
        orders.pop_front();
      }
      if (state == "COMPLETED") run_task(script, task);
    }
    return {};
  }

  [[nodiscard]] std::optional<SlurmQueue> queue(const std::vector<std::string>&) override {
    std::string text;
    for (const auto& [task, state] : states) text += task + "|" + state + "\n";
    return SlurmQueue(text);
  }

  void cancel(const std::vector<std::string>& names) override {
    for (const std::string& name : names) {
      cancelled.push_back(name);
      for (auto& [task, state] : states)
        if (task.starts_with(name) && is_active(state)) state = "CANCELLED";
    }
  }

  /// What the cluster does when the time has come.
  void run_task(const std::filesystem::path& script, int task) {
    (void)std::system(fmt::format("SLURM_ARRAY_TASK_ID={} bash {}", task, script.string()).c_str());
  }

  std::string refusal;
  std::deque<std::string> orders;             ///< states of the next tasks
  std::map<std::string, std::string> states;  ///< of "array|task"
  std::vector<std::string> arrays;
  std::vector<std::vector<std::string>> submitted;
  std::vector<std::string> cancelled;
};

/// Jobs whose calls are scripts of the shell.
class SlurmLaunching : public ::testing::Test {
 protected:
  SlurmLaunching() {
    options_.file_lag_s = 0;
    options_.backoff_s = 0.01;
  }

  void add(const std::string& name, const std::vector<std::string>& scripts) {
    LaunchJob job{name, {}, folder_.path() / "jobs" / name / "log.txt", "made of this"};
    for (const std::string& script : scripts) job.commands.push_back({"-c", script});
    jobs_.push_back(job);
  }

  /// A script that leaves a line each time it runs.
  [[nodiscard]] std::string count(const std::string& name) const {
    return "echo run >> " + (folder_.path() / (name + ".count")).string();
  }
  [[nodiscard]] std::string runs_of(const std::string& name) const {
    return read_file(folder_.path() / (name + ".count"));
  }

  /// With a cluster that is seen as `cluster_` while it runs.
  bool run(
      const LaunchLimits& limits = {LaunchLimits::kUnlimited, 1},
      const std::function<void()>& on_wait = [] {}) {
    /// The launcher owns what forwards to the test's cluster.
    class Forward : public SlurmCluster {
     public:
      explicit Forward(FakeCluster& to) : to_(to) {}
      void check() override {}
      [[nodiscard]] int max_array_size() override { return to_.max_array_size(); }
      [[nodiscard]] std::string submit(const std::filesystem::path& script,
                                       const std::vector<std::string>& options) override {
        return to_.submit(script, options);
      }
      [[nodiscard]] std::optional<SlurmQueue> queue(
          const std::vector<std::string>& arrays) override {
        return to_.queue(arrays);
      }
      void cancel(const std::vector<std::string>& arrays) override { to_.cancel(arrays); }

     private:
      FakeCluster& to_;
    };
    SlurmLauncher launcher({"/bin/sh", folder_.path(), options_},
                           std::make_unique<Forward>(cluster_), std::chrono::milliseconds(10));
    const auto on_end = [&](std::size_t i, const LaunchResult& result) {
      EXPECT_FALSE(results_.contains(jobs_[i].name)) << "told twice";
      results_[jobs_[i].name] = result;
    };
    return launcher.run(jobs_, limits,
                        {on_end, on_wait, [&](const std::string& note) { notes_ += note; }});
  }

  [[nodiscard]] std::string log(const std::string& name) const {
    return read_file(folder_.path() / "jobs" / name / "log.txt");
  }

  TemporaryFolder folder_;
  SlurmOptions options_;
  FakeCluster cluster_;
  std::vector<LaunchJob> jobs_;
  std::map<std::string, LaunchResult> results_;
  std::string notes_;
};

TEST_F(SlurmLaunching, LogsAndEndsAsTheLocalLauncherDoes) {
  add("good", {"echo 'it'\\''s one'; echo two >&2", "echo three"});
  add("bad", {"true", "exit 3", "echo never"});
  add("killed", {"kill -11 $$"});
  EXPECT_TRUE(run());
  EXPECT_TRUE(results_.at("good").succeeded);
  EXPECT_EQ(log("good"),
            "$ saccade -c 'echo '\\''it'\\''\\'\\'''\\''s one'\\''; echo two >&2'\nit's one\ntwo\n"
            "$ saccade -c 'echo three'\nthree\n");
  EXPECT_EQ(results_.at("bad").problem, "exit code 3");
  EXPECT_EQ(results_.at("bad").failed, jobs_[1].commands[1]);
  EXPECT_EQ(results_.at("killed").problem, "killed by signal 11 (Segmentation fault)");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "slurm")) << "nothing is left";
}

TEST_F(SlurmLaunching, TellsSlurmWhatWasAskedFor) {
  options_.options = {"--partition=long", "--account=vision"};
  options_.jobs_per_task = 2;
  for (const char* name : {"a", "b", "c", "d", "e"}) add(name, {"true"});
  EXPECT_TRUE(run({2, 4}));
  EXPECT_THAT(cluster_.submitted.at(0),
              ElementsAre(HasSubstr("--job-name=saccade-"), "--array=0-2%2", HasSubstr("--output="),
                          "--nodes=1", "--ntasks=1", "--no-requeue", "--cpus-per-task=4",
                          "--partition=long", "--account=vision"));
  EXPECT_EQ(results_.size(), 5U);
  EXPECT_EQ(sbatch_options({}, 0, {}).back(), "--exclusive");
}

TEST_F(SlurmLaunching, SplitsWhatIsMoreThanAnArrayTakes) {
  options_.max_array_size = 2;
  for (const char* name : {"a", "b", "c", "d", "e"}) add(name, {count("all")});
  EXPECT_TRUE(run({1, 1}));
  EXPECT_EQ(cluster_.arrays.size(), 3U);
  EXPECT_EQ(runs_of("all"), "run\nrun\nrun\nrun\nrun\n");
}

TEST_F(SlurmLaunching, SubmitsLostJobsAgainAndGivesUpInTheEnd) {
  add("once", {count("once")});
  add("always", {count("always")});
  // Tasks 0 and 1, then both again, then the one that was lost twice.
  cluster_.orders = {"NODE_FAIL", "NODE_FAIL", "COMPLETED", "FAILED", "NODE_FAIL"};
  EXPECT_TRUE(run());
  EXPECT_TRUE(results_.at("once").succeeded);
  EXPECT_EQ(runs_of("once"), "run\n");
  EXPECT_EQ(results_.at("always").problem,
            "was lost before it began (Slurm: NODE_FAIL), in the last of 3 attempts");
  EXPECT_THAT(
      notes_,
      AllOf(HasSubstr("job once was lost before it began (Slurm: NODE_FAIL); attempt 2 of 3"),
            HasSubstr("(Slurm: FAILED); attempt 3 of 3 follows")));
}

TEST_F(SlurmLaunching, SaysWhySlurmEndedAJob) {
  add("slow", {"true"});
  add("large", {"true"});
  add("unwanted", {"true"});
  cluster_.orders = {"TIMEOUT", "OUT_OF_MEMORY", "CANCELLED"};
  EXPECT_TRUE(run());
  EXPECT_THAT(results_.at("slow").problem, HasSubstr("time limit"));
  EXPECT_THAT(results_.at("large").problem, HasSubstr("out of memory"));
  EXPECT_THAT(results_.at("unwanted").problem, HasSubstr("cancel"));
  EXPECT_EQ(cluster_.arrays.size(), 1U) << "none of them is tried again";
}

TEST_F(SlurmLaunching, WhatExceedsItsRequestIsTriedWithTwiceAsMuch) {
  options_.request = {10, 2000};
  add("slow", {count("slow")});
  add("large", {count("large")});
  add("endless", {count("endless")});
  // All three, then one by one, since they request different things.
  cluster_.orders = {"TIMEOUT",   "OUT_OF_MEMORY", "TIMEOUT", "COMPLETED",
                     "COMPLETED", "TIMEOUT",       "TIMEOUT"};
  EXPECT_TRUE(run());
  EXPECT_THAT(cluster_.submitted.at(0), Contains("--time=10"));
  EXPECT_THAT(cluster_.submitted.at(0), Contains("--mem=2000M"));
  EXPECT_THAT(cluster_.submitted.at(1), Contains("--time=20"));
  EXPECT_THAT(cluster_.submitted.at(1), Contains("--mem=4000M"));
  EXPECT_THAT(cluster_.submitted.at(2), Contains("--time=40"));
  EXPECT_TRUE(results_.at("slow").succeeded);
  EXPECT_TRUE(results_.at("large").succeeded);
  EXPECT_THAT(results_.at("endless").problem, HasSubstr("time limit"));
  EXPECT_THAT(
      notes_,
      AllOf(HasSubstr("job slow exceeded its time; attempt 2 of 3 follows with 20 minutes"),
            HasSubstr("job large exceeded its memory; attempt 2 of 3 follows with 4000 MB")));
}

TEST_F(SlurmLaunching, ALostJobWaitsBeforeTheNextAttempt) {
  options_.backoff_s = 0.3;
  add("a", {count("a")});
  cluster_.orders = {"PREEMPTED"};
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(run());
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(300));
  EXPECT_THAT(notes_, HasSubstr("attempt 2 of 3 follows in 0 s"));
  EXPECT_TRUE(results_.at("a").succeeded);
}

TEST_F(SlurmLaunching, JobsOfKnownCostRequestWhatTheyNeed) {
  for (const char* name : {"a", "b", "c"}) add(name, {"true"});
  jobs_[0].cost = jobs_[2].cost = LaunchJob::Cost{60, 1000};
  jobs_[1].cost = LaunchJob::Cost{6000, {}};
  EXPECT_TRUE(run());
  ASSERT_EQ(cluster_.submitted.size(), 2U) << "an array for each request";
  EXPECT_THAT(cluster_.submitted.at(0), Contains("--array=0-1"));
  EXPECT_THAT(cluster_.submitted.at(0), Contains("--time=4"));  // three minutes, rounded up
  EXPECT_THAT(cluster_.submitted.at(0), Contains("--mem=2048M"));
  EXPECT_THAT(cluster_.submitted.at(1), Contains("--time=363"));
  EXPECT_THAT(cluster_.submitted.at(1), Not(Contains(HasSubstr("--mem"))));
}

TEST(SlurmRequest, IsTheSameForJobsOfAboutOneSize) {
  EXPECT_EQ(request_like(100, 900), request_like(110, 920));
  EXPECT_FALSE(request_like(100, 900) == request_like(400, 900));
  EXPECT_GE(*request_like(600, {}).minutes, 30);
  EXPECT_LE(*request_like(600, {}).minutes, 43);
  EXPECT_GE(*request_like(0.01, {}).minutes, 2);
}

TEST_F(SlurmLaunching, RunsInsideAContainer) {
  // In place of Apptainer what shows how it is called, and runs the command without a container.
  const std::filesystem::path runtime = folder_.write(
      "bin/apptainer", "#!/bin/bash\necho \"$@\" >> " + (folder_.path() / "calls.txt").string() +
                           "\n[[ $1 == exec && $2 == --bind && $5 == saccade ]] || exit 9\nshift "
                           "5\nexec /bin/sh \"$@\"\n");
  std::filesystem::permissions(runtime, std::filesystem::perms::owner_all);
  const std::string before = std::getenv("PATH");
  setenv("PATH", (runtime.parent_path().string() + ":" + before).c_str(), 1);
  options_.container = folder_.write("image.sif", "an image");
  add("a", {"echo inside"});
  EXPECT_TRUE(run());
  setenv("PATH", before.c_str(), 1);
  EXPECT_TRUE(results_.at("a").succeeded) << log("a");
  EXPECT_THAT(log("a"), HasSubstr("inside\n"));
  EXPECT_THAT(
      read_file(folder_.path() / "calls.txt"),
      AllOf(HasSubstr("--bind " + folder_.path().string()), HasSubstr("image.sif saccade -c")));
}

TEST_F(SlurmLaunching, ATimeLimitIsTheFaultOfTheJobThatRan) {
  options_.jobs_per_task = 3;
  for (const char* name : {"a", "b", "c"}) add(name, {count(name)});
  cluster_.orders = {"TIMEOUT"};
  EXPECT_TRUE(run());
  EXPECT_FALSE(results_.at("a").succeeded);
  EXPECT_TRUE(results_.at("b").succeeded);
  EXPECT_TRUE(results_.at("c").succeeded);
  EXPECT_EQ(runs_of("c"), "run\n");
}

TEST_F(SlurmLaunching, TakesOverWhatAnEarlierCallSubmitted) {
  std::signal(SIGHUP, SIG_DFL);
  add("done", {count("done")});
  add("queued", {count("queued")});
  add("lost", {count("lost")});
  cluster_.orders = {"PENDING", "PENDING", "PENDING"};
  EXPECT_FALSE(run({2, 1}, [] { std::raise(SIGHUP); }));
  EXPECT_TRUE(results_.empty());
  EXPECT_TRUE(cluster_.cancelled.empty()) << "a lost terminal leaves the queue alone";
  // Between two polls one job ends and one is lost.
  const std::string array = cluster_.arrays.at(0);
  cluster_.run_task(folder_.path() / "slurm" / array / "array.sh", 0);
  cluster_.states[array + "|0"] = "COMPLETED";
  cluster_.states[array + "|2"] = "NODE_FAIL";
  int polls = 0;
  EXPECT_TRUE(run({2, 1}, [&] {
    if (++polls != 3) return;
    cluster_.run_task(folder_.path() / "slurm" / array / "array.sh", 1);
    cluster_.states[array + "|1"] = "COMPLETED";
  }));
  for (const char* name : {"done", "queued", "lost"}) {
    EXPECT_TRUE(results_.at(name).succeeded) << name;
    EXPECT_EQ(runs_of(name), "run\n") << name;
  }
  EXPECT_EQ(cluster_.arrays.size(), 2U) << "only the lost one is submitted again";
}

TEST_F(SlurmLaunching, CancelsWhatIsOutdatedOrInterrupted) {
  std::signal(SIGINT, SIG_DFL);
  add("a", {count("a")});
  cluster_.orders = {"RUNNING", "RUNNING"};
  std::signal(SIGHUP, SIG_DFL);
  EXPECT_FALSE(run({2, 1}, [] { std::raise(SIGHUP); }));
  jobs_[0].identity = "made of something else";
  EXPECT_FALSE(run({2, 1}, [] { std::raise(SIGINT); }));
  EXPECT_EQ(cluster_.cancelled, cluster_.arrays) << "the one for its inputs, the other by request";
  EXPECT_EQ(cluster_.arrays.size(), 2U);
  EXPECT_TRUE(run());
  EXPECT_TRUE(results_.at("a").succeeded);
  EXPECT_EQ(runs_of("a"), "run\n");
}

TEST_F(SlurmLaunching, ARefusalIsAnError) {
  add("a", {"true"});
  cluster_.refusal = "sbatch: error: invalid partition specified: lnog";
  EXPECT_THAT(error_of([&] { return run(); }), HasSubstr("invalid partition"));
}

}  // namespace
}  // namespace saccade
