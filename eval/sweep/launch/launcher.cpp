#include "eval/sweep/launch/launcher.h"

#include <poll.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "core/check.h"
#include "core/config/suggest.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/child_process.h"
#include "core/process/fork_server.h"
#include "core/process/program.h"
#include "core/stopwatch.h"
#include "eval/sweep/launch/slurm_launcher.h"

namespace saccade {
namespace {

constexpr int kWaitMs = 200;
/// Children that do not end this long after they were asked to are killed [s].
constexpr double kStopTimeoutS = 5;

/// A job whose command number `command` is running.
struct Running {
  std::size_t index;
  std::size_t command;
  Stopwatch stopwatch;
  ChildProcess process;
};

/// Starts commands of jobs.
class Starter {
 public:
  Starter(std::filesystem::path program, bool is_fork_server)
      : program_(std::move(program)), is_fork_server_(is_fork_server) {}

  ChildProcess start(const LaunchJob& job, std::size_t command) {
    std::vector<std::string> words{"saccade"};
    words.insert(words.end(), job.commands[command].begin(), job.commands[command].end());
    if (!is_fork_server_) return ChildProcess(program_, words, job.log);
    try {
      if (!server_) server_.emplace(program_);
      return server_->start(words, job.log);
    } catch (const InputError&) {
      // Somebody may have killed the server, and with it the jobs that it had started, but no others.
      server_.emplace(program_);
      return server_->start(words, job.log);
    }
  }

 private:
  std::filesystem::path program_;
  bool is_fork_server_;
  std::optional<ForkServer> server_;
};

/// Sleeps until a child ends, a signal arrives or kWaitMs have passed.
void wait_for_any(const std::vector<Running>& running) {
  std::vector<pollfd> ends;
  ends.reserve(running.size());
  for (const Running& one : running) ends.push_back({one.process.descriptor(), POLLIN, 0});
  ::poll(ends.data(), ends.size(), kWaitMs);
}

void stop_all(std::vector<Running>& running) {
  for (Running& one : running) one.process.stop();
  const Stopwatch stopwatch;
  while (!running.empty()) {
    wait_for_any(running);
    for (auto one = running.begin(); one != running.end();)
      one = one->process.poll_end() ? running.erase(one) : one + 1;
    if (stopwatch.seconds() > kStopTimeoutS) running.clear();  // the destructor kills
  }
}

/// Starts the next command of a job after one has ended. Returns the result where the job has
/// ended.
std::optional<LaunchResult> advance(Running& one, const ChildEnd& end, const LaunchJob& job,
                                    Starter& starter) {
  const double wall_s = one.stopwatch.seconds();
  if (end.exit_code != 0) return LaunchResult{false, end.text(), job.commands[one.command], wall_s};
  if (++one.command == job.commands.size()) return LaunchResult{true, {}, {}, wall_s};
  one.process = starter.start(job, one.command);
  return std::nullopt;
}

/// Child processes of this program on this machine.
class LocalLauncher : public Launcher {
 public:
  LocalLauncher(std::filesystem::path program, bool is_fork_server)
      : program_(std::move(program)), is_fork_server_(is_fork_server) {}

  [[nodiscard]] bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                         const LaunchCallbacks& callbacks) override;
  /// As many as their threads fit the cores.
  [[nodiscard]] int default_parallel_jobs(int threads) const override;

 private:
  std::filesystem::path program_;
  bool is_fork_server_;
};

int LocalLauncher::default_parallel_jobs(int threads) const {
  if (threads == 0) return 1;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::max(1, cores / threads);
}

bool LocalLauncher::run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                        const LaunchCallbacks& callbacks) {
  SACCADE_CHECK(limits.parallel_jobs >= 1);
  const InterruptGuard interrupt;
  Starter starter(program_, is_fork_server_);
  std::vector<Running> running;
  std::size_t next = 0;
  while (next < jobs.size() || !running.empty()) {
    for (; next < jobs.size() && running.size() < static_cast<std::size_t>(limits.parallel_jobs);
         ++next) {
      write_atomically(jobs[next].log, "");
      running.push_back({next, 0, {}, starter.start(jobs[next], 0)});
    }
    wait_for_any(running);
    callbacks.on_wait();
    if (interrupt.requested()) {
      stop_all(running);
      return false;
    }
    for (auto one = running.begin(); one != running.end();) {
      std::optional<LaunchResult> result;
      if (const std::optional<ChildEnd> end = one->process.poll_end())
        result = advance(*one, *end, jobs[one->index], starter);
      if (result) callbacks.on_end(one->index, *result);
      one = result ? running.erase(one) : one + 1;
    }
  }
  return true;
}

}  // namespace

std::unique_ptr<Launcher> make_launcher(const std::string& name, LauncherOptions options) {
  const std::vector<std::string> names{"local", "slurm"};
  if (options.program.empty()) options.program = program_file();
  if (name == names[0])
    return std::make_unique<LocalLauncher>(options.program, options.is_fork_server);
  if (name == names[1])
    return std::make_unique<SlurmLauncher>(options, std::make_unique<SlurmCommands>());
  throw InputError("--launcher", "there is no launcher '" + name + "'; " +
                                     config::suggestion(name, names, "launchers"));
}

}  // namespace saccade
