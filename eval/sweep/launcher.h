#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace saccade {

/// Calls of `saccade`, made one after another until one fails.
struct LaunchJob {
  std::string name;
  std::vector<std::vector<std::string>> commands;  ///< arguments
  std::filesystem::path log;                       ///< gets what they print; replaced
};

/// How a job ended.
struct LaunchResult {
  bool succeeded = false;
  std::string problem;  ///< "exit code 2", "killed by signal 9"; empty when it succeeded
  std::vector<std::string> failed;  ///< the call that failed
  double wall_s = 0;
};

/// Where the jobs of a sweep run. A launcher needs to know nothing of sweeps: jobs are command
/// lines and paths that stay valid on every machine that shares the file system.
class Launcher {
 public:
  Launcher() = default;
  virtual ~Launcher() = default;
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;

  /// Runs all jobs, at most `at_once` >= 1 at any time, and begins them in their order. `on_end` is
  /// called in this thread, with the index of a job, as jobs end; `on_wait` some times a second.
  /// Returns false when it was interrupted (SIGINT, SIGTERM, SIGHUP): what was running is stopped,
  /// without an on_end.
  [[nodiscard]] virtual bool run(
      std::span<const LaunchJob> jobs, int at_once,
      const std::function<void(std::size_t, const LaunchResult&)>& on_end,
      const std::function<void()>& on_wait) = 0;
};

/// "local": child processes on this machine. InputError that lists the names for another one.
/// `program`: what is run; the running program by default.
[[nodiscard]] std::unique_ptr<Launcher> make_launcher(const std::string& name,
                                                      const std::filesystem::path& program = {});

}  // namespace saccade
