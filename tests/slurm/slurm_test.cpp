// Sweeps on a real Slurm, which tests/slurm/single_node starts: the same tables as on this machine
// alone, and nothing lost or done twice when processes are killed. SACCADE_SLURM_JOBS sets the
// number of jobs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <thread>

#include "tests/support/source_path.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string single_node() { return testing::source_path("tests/slurm/single_node"); }

int jobs_of_sweep() {
  const char* text = std::getenv("SACCADE_SLURM_JOBS");
  return text == nullptr ? 12 : std::atoi(text);
}

/// Why no cluster can be started here; empty where it can.
std::string why_not() {
  if (geteuid() != 0) return "only root can start Slurm's daemons";
  for (const char* program : {"sbatch", "munged", "slurmctld", "slurmd"})
    if (!on_search_path(program) && !fs::exists(fs::path("/usr/sbin") / program))
      return std::string(program) +
             " is not here: apt-get install slurmctld slurmd slurm-client munge";
  return {};
}

/// `saccade` in the background.
class Background {
 public:
  Background(std::vector<std::string> arguments, fs::path log) : log_(std::move(log)) {
    arguments.insert(arguments.begin(), SACCADE_COMMAND);
    std::fflush(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    if (std::freopen(log_.c_str(), "w", stdout) == nullptr) _exit(127);
    dup2(STDOUT_FILENO, STDERR_FILENO);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    execv(SACCADE_COMMAND, argv.data());
    _exit(127);
  }
  ~Background() {
    if (child_ > 0) stop(SIGKILL);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  [[nodiscard]] bool is_over() {
    if (child_ > 0 && waitpid(child_, &status_, WNOHANG) == child_) child_ = -1;
    return child_ < 0;
  }
  void stop(int signal) {
    kill(child_, signal);
    wait();
  }
  /// Its exit code.
  int wait() {
    if (child_ > 0) waitpid(child_, &status_, 0);
    child_ = -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }
  [[nodiscard]] std::string output() const { return read_file(log_); }

 private:
  fs::path log_;
  pid_t child_ = -1;
  int status_ = 0;
};

class OnSlurm : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string reason = why_not(); !reason.empty()) GTEST_SKIP() << reason;
    node("start");
    started_ = true;
    setenv("SLURM_CONF", (folder_.path() / "cluster/slurm.conf").c_str(), 1);
  }
  void TearDown() override {
    if (started_) node("stop");
  }

  void node(const std::string& verb) const {
    const CommandResult result = run_command(single_node(), {verb, folder_.path() / "cluster"});
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }

  /// So many runs over a twentieth of a second of Walls, a pair for each number of samples.
  [[nodiscard]] std::string write_sweep(int jobs, const std::string& more = "") const {
    std::string samples;
    for (int i = 0; i < (jobs + 1) / 2; ++i)
      samples += (i == 0 ? "" : ", ") + std::to_string(20 + i);
    return folder_.write(
        "sweep.yaml",
        "datasets:\n"
        "  - simulate: " +
            shipped_config("simulation/walls.yaml") +
            "\n"
            "    set:\n"
            "      duration_s: 0.05\n"
            "      camera: {width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}\n"
            "configurations: [{file: " +
            shipped_config("tracking/fast.yaml") +
            "}]\n"
            "grid: {edges.samples: [" +
            samples +
            "]}\n"
            "seeds: [1, 2]\n" +
            more);
  }

  /// In turn the program, a job, the script around one, and the daemon of the node. What it was.
  std::string kill_something(int turn, Background& sweep, const fs::path& out);

  TemporaryFolder folder_;
  bool started_ = false;
};

using Cells = std::vector<std::vector<std::string>>;

/// A table without the columns that depend on how busy the machine was.
Cells table_but_speeds(const fs::path& file) {
  Cells rows;
  std::vector<bool> kept;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (rows.empty()) kept.push_back(!cell.starts_with("speed."));
      if (kept.at(column)) row.push_back(cell);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Runs that are complete, and when they were.
std::map<std::string, fs::file_time_type> finished_runs(const fs::path& out) {
  std::map<std::string, fs::file_time_type> finished;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(out / "jobs", ignored)) {
    const std::string name = entry.path().filename();
    if (fs::exists(entry.path() / "job.yaml") && fs::exists(out / "runs" / name / "run.yaml"))
      finished[name] = fs::last_write_time(out / "runs" / name / "run.yaml");
  }
  return finished;
}

/// Runs that were complete are the same files still.
void expect_kept(const std::map<std::string, fs::file_time_type>& finished, const fs::path& out) {
  const auto now = finished_runs(out);
  for (const auto& [name, time] : finished)
    EXPECT_TRUE(now.contains(name) && now.at(name) == time) << name << " was run again";
}

/// Kills a process with both texts in its command line, if there is one.
bool kill_process(const std::string& first, const std::string& second) {
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    // A process may end between being listed and being read. Its file then fails to be read, which an iterator over the
    // stream's buffer would throw; the insertion leaves the text empty.
    std::ostringstream text;
    text << std::ifstream(entry.path() / "cmdline", std::ios::binary).rdbuf();
    const std::string line = text.str();
    if (line.find(first) == std::string::npos || line.find(second) == std::string::npos) continue;
    return kill(std::stoi(name), SIGKILL) == 0;
  }
  return false;
}

std::string OnSlurm::kill_something(int turn, Background& sweep, const fs::path& out) {
  const auto kill_one = [&](const std::string& first, const std::string& second) {
    while (!sweep.is_over() && !kill_process(first, second))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  if (turn % 4 == 0) {
    if (!sweep.is_over()) sweep.stop(SIGKILL);
    return "the program";
  }
  if (turn % 4 == 1) {
    kill_one("track", out);
    return "a job";
  }
  if (turn % 4 == 2) {
    kill_one("slurm_script", folder_.path() / "cluster");
    return "the script of a job";
  }
  node("kill-node");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  node("start-node");
  return "the daemon of the node";
}

TEST_F(OnSlurm, TheTableIsThatOfThisMachineAlone) {
  const std::string sweep = write_sweep(jobs_of_sweep());
  const fs::path local = folder_.path() / "local", slurm = folder_.path() / "slurm";
  saccade_ok({"sweep", sweep, "-o", local});
  saccade_ok({"sweep", sweep, "-o", slurm, "--launcher", "slurm", "--jobs", "2"});
  const Cells expected = table_but_speeds(local / "sweep.csv");
  EXPECT_EQ(expected.size(), static_cast<std::size_t>(jobs_of_sweep()) + 1);
  EXPECT_EQ(table_but_speeds(slurm / "sweep.csv"), expected);
  EXPECT_THAT(saccade_ok({"sweep", sweep, "-o", slurm, "--launcher", "slurm"}),
              HasSubstr("0 jobs done, " + std::to_string(jobs_of_sweep() + 1) + " done before"));
  EXPECT_FALSE(fs::exists(slurm / "slurm"));
}

TEST_F(OnSlurm, NothingIsDoneTwiceWhateverIsKilled) {
  constexpr int kKills = 8;
  const int jobs = jobs_of_sweep();
  const fs::path out = folder_.path() / "out", log = folder_.path() / "log.txt";
  const std::vector<std::string> words{
      "sweep", write_sweep(jobs, "repeat: 20\n"), "-o", out, "--launcher", "slurm", "--jobs", "2"};
  std::mt19937 random(7);
  auto sweep = std::make_unique<Background>(words, log);
  std::map<std::string, fs::file_time_type> finished;
  int calls = 1;
  for (int turn = 0; turn < kKills; ++turn) {
    const std::size_t until =
        finished.size() + 1 + random() % static_cast<unsigned>(std::max(1, jobs / kKills));
    while (!sweep->is_over() && finished_runs(out).size() < until)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    expect_kept(finished, out);
    finished = finished_runs(out);
    const std::string killed = kill_something(turn, *sweep, out);
    std::printf("%zu of %d runs done: %s killed\n", finished.size(), jobs, killed.c_str());
    if (!sweep->is_over()) continue;
    sweep = std::make_unique<Background>(words, log);
    ++calls;
  }
  // A job that was killed has failed, and is done by the next call.
  int exit_code = sweep->wait();
  for (; exit_code == 1; ++calls) {
    EXPECT_THAT(sweep->output(), HasSubstr("failed with killed by signal 9"));
    sweep = std::make_unique<Background>(words, log);
    exit_code = sweep->wait();
  }
  std::printf("%zu runs done by %d calls\n", finished_runs(out).size(), calls);
  EXPECT_EQ(exit_code, 0) << sweep->output();
  EXPECT_EQ(finished_runs(out).size(), static_cast<std::size_t>(jobs));
  expect_kept(finished, out);
}

TEST_F(OnSlurm, SaysWhyAJobFailed) {
  const fs::path out = folder_.path() / "out";
  Background sweep({"sweep", write_sweep(2, "repeat: 100000\n"), "-o", out, "--launcher", "slurm"},
                   folder_.path() / "log.txt");
  while (!sweep.is_over() && !fs::exists(out / "jobs/walls_fast_samples-20_seed-2/log.txt"))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(run_command("/usr/bin/scancel", {"--user=root"}).exit_code, 0);
  EXPECT_EQ(sweep.wait(), 1);
  EXPECT_THAT(sweep.output(), HasSubstr("failed with a cancellation (scancel)"));
  EXPECT_THAT(saccade({"sweep", write_sweep(2), "-o", out, "--launcher", "slurm",
                       "--slurm-option=--partition=nowhere"})
                  .output,
              HasSubstr("invalid partition"));
}

}  // namespace
}  // namespace saccade::testing
