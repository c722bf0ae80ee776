#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/process/child_process.h"

namespace saccade {

/// Starts commands of a program as copies of a process that has loaded it already and done nothing
/// else: loading it, with all of its libraries, takes longer than a short command does.
class ForkServer {
 public:
  /// `program`: one whose main() calls serve_forks() where is_fork_server(). Throws InputError when
  /// it cannot be started.
  explicit ForkServer(const std::filesystem::path& program);
  ~ForkServer();  ///< what it has started goes on
  ForkServer(const ForkServer&) = delete;
  ForkServer& operator=(const ForkServer&) = delete;

  /// `words`: what the program is called and its arguments; the system's list of processes shows those of
  /// the server instead. Everything else is as if ChildProcess had started it. Throws InputError when it
  /// cannot be started, or the log not be written.
  [[nodiscard]] ChildProcess start(const std::vector<std::string>& words,
                                   const std::filesystem::path& log);

 private:
  pid_t server_ = -1;
  int socket_ = -1;
};

/// Whether this program is to be a fork server; for main(), before other threads are started.
[[nodiscard]] bool is_fork_server(int argc, const char* const* argv);

/// Lets `command` run in copies of this process, with the arguments of main(), until the ForkServer
/// is gone. Returns the exit code: 0, or 2 where nobody but a user has called it.
[[nodiscard]] int serve_forks(const std::function<int(int, char**)>& command);

}  // namespace saccade
