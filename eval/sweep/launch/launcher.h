#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "eval/sweep/launch/slurm_options.h"

namespace saccade {

/// Calls of `saccade`, made one after another until one fails.
struct LaunchJob {
  std::string name;
  std::vector<std::vector<std::string>> commands;  ///< arguments
  std::filesystem::path log;                       ///< gets what they print; replaced
  std::string identity;  ///< of all that the result depends on; tells a job of another call apart
};

/// How a job ended.
struct LaunchResult {
  bool succeeded = false;
  std::string problem;  ///< "exit code 2", "killed by signal 9"; empty when it succeeded
  std::vector<std::string> failed;  ///< the call that failed
  double wall_s = 0;
};

/// How much of a machine jobs may take.
struct LaunchLimits {
  int parallel_jobs = 1;  ///< jobs at any time, >= 1; kAllAtOnce: no limit
  int threads = 1;  ///< of one job; 0: all of its machine, which then does nothing else

  static constexpr int kAllAtOnce = std::numeric_limits<int>::max();
};

/// What a launcher tells while jobs run, in the thread that called it.
struct LaunchCallbacks {
  std::function<void(std::size_t, const LaunchResult&)> on_end;  ///< of the job with this index
  std::function<void()> on_wait;                                 ///< some times a second
  std::function<void(const std::string&)> on_note;  ///< what went wrong and was put right
};

/// Where the jobs of a sweep run. A launcher needs to know nothing of sweeps: jobs are command
/// lines and paths that stay valid on every machine that shares the file system.
class Launcher {
 public:
  Launcher() = default;
  virtual ~Launcher() = default;
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;

  /// Runs all jobs and begins them in their order. Returns false when it was interrupted (SIGINT,
  /// SIGTERM, SIGHUP): what was running is stopped, or goes on where the launcher can find it
  /// again, without an on_end.
  [[nodiscard]] virtual bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                                 const LaunchCallbacks& events) = 0;
  /// How many jobs of `threads` >= 0 threads (0: all of a machine) run at a time unless somebody
  /// states it.
  [[nodiscard]] virtual int default_parallel_jobs(int threads) const = 0;
};

/// What launchers need to know of the sweep.
struct LauncherOptions {
  std::filesystem::path program;  ///< that is run; empty: the running one
  std::filesystem::path folder;   ///< of the sweep; `slurm` keeps its records there
  SlurmOptions slurm;
};

/// "local": child processes on this machine; "slurm": arrays of jobs on a cluster. InputError that
/// lists the names for another one.
[[nodiscard]] std::unique_ptr<Launcher> make_launcher(const std::string& name,
                                                      LauncherOptions options = {});

}  // namespace saccade
