#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/sweep/launch/slurm_options.h"

namespace saccade {

/// Commands of `saccade` that run one after another until one fails.
struct LaunchJob {
  std::string name;
  std::vector<std::vector<std::string>> commands;  ///< their arguments
  std::filesystem::path log;                       ///< receives their output; replaced
  std::string identity;  ///< hash of everything that the result depends on
  /// What a job like this one took; nullopt: not known.
  struct Cost {
    double wall_s = 0;
    std::optional<double> memory_mb;
  };
  std::optional<Cost> cost = {};
};

/// The result of a job.
struct LaunchResult {
  bool succeeded = false;
  std::string problem;  ///< "exit code 2", "killed by signal 9"; empty when it succeeded
  std::vector<std::string> failed;  ///< arguments of the command that failed
  double wall_s = 0;
};

/// The resources that jobs may use.
struct LaunchLimits {
  int parallel_jobs = 1;  ///< jobs that run at the same time, >= 1; kUnlimited: all
  int threads = 1;        ///< of one job; 0: a whole machine of its own

  static constexpr int kUnlimited = std::numeric_limits<int>::max();
};

/// Functions that a launcher calls while jobs run, in the thread that called it.
struct LaunchCallbacks {
  std::function<void(std::size_t, const LaunchResult&)> on_end;  ///< the job with this index ended
  std::function<void()> on_wait;                                 ///< several times per second
  std::function<void(const std::string&)> on_note;               ///< a problem that was handled
};

/// Runs the jobs of a sweep. A launcher knows nothing of sweeps: jobs are command lines and paths
/// that are valid on every machine that shares the file system.
class Launcher {
 public:
  Launcher() = default;
  virtual ~Launcher() = default;
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;

  /// Runs all jobs and starts them in their order. Returns false when it was interrupted (SIGINT,
  /// SIGTERM, SIGHUP): running jobs are stopped, or continue where the launcher can adopt them
  /// later; on_end is not called for them.
  [[nodiscard]] virtual bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                                 const LaunchCallbacks& callbacks) = 0;
  /// The number of jobs of `threads` >= 0 threads (0: a whole machine) that run in parallel by
  /// default.
  [[nodiscard]] virtual int default_parallel_jobs(int threads) const = 0;
  /// What the results depend on besides the program here, as a container; empty: nothing.
  [[nodiscard]] virtual std::string environment() const { return {}; }
  /// Whether it wants to know LaunchJob::cost, so that one job of each kind is to run before the
  /// others.
  [[nodiscard]] virtual bool wants_costs() const { return false; }
};

/// Settings of the launchers.
struct LauncherOptions {
  std::filesystem::path program;  ///< empty: the running one
  std::filesystem::path folder;   ///< of the sweep; `slurm` keeps its records there
  SlurmOptions slurm;
  bool is_fork_server = false;  ///< `program` can be one (core/process/fork_server.h)
};

/// "local": child processes on this machine; "slurm": job arrays on a cluster. Throws InputError
/// that lists the valid names for any other name.
[[nodiscard]] std::unique_ptr<Launcher> make_launcher(const std::string& name,
                                                      LauncherOptions options = {});

}  // namespace saccade
