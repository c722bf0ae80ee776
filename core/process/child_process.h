#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// How a process ended.
struct ChildEnd {
  int exit_code = -1;  ///< -1: by a signal
  int signal = 0;
  /// Of the process and those below it that it waited for.
  double cpu_s = 0;
  /// Of the largest one; at least what their parent had taken when it started them, which the system
  /// counts as theirs.
  double peak_memory_mb = 0;

  /// "exit code 2" or "killed by signal 9 (Killed)".
  [[nodiscard]] std::string text() const;
  /// As wait4() tells it.
  [[nodiscard]] static ChildEnd of(int status, const rusage& usage);
};

/// Appends the words to a log as a line that a shell runs again. Throws InputError when it cannot be
/// written.
void begin_log(const std::filesystem::path& log, const std::vector<std::string>& words);

/// A program that runs beside this one, in a process group of its own, so that Ctrl-C in the
/// terminal reaches it through stop() alone. It reads nothing.
class ChildProcess {
 public:
  /// `program`: a file, or a name that is looked for in $PATH. `words`: what it is called and its
  /// arguments. What it prints is appended to `log`, behind the words. `working_folder`: empty is
  /// this program's. Throws InputError when it cannot be started or the log not be written.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& words,
               const std::filesystem::path& log, const std::filesystem::path& working_folder = {});
  /// A process of another parent, which writes how it ended, a ChildEnd, to the other end of the
  /// pipe `told_end`; that the pipe ends without it counts as being killed.
  ChildProcess(pid_t pid, int told_end) : pid_(pid), descriptor_(told_end), is_told_(true) {}
  ~ChildProcess();  ///< kills what is still running
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// Readable for poll() as soon as the process has ended.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// How it ended; nullopt while it runs. An end is told once.
  [[nodiscard]] std::optional<ChildEnd> poll_end();
  /// The most memory that it, or the largest process below it, has taken so far [MB]; of those that
  /// run at this moment.
  [[nodiscard]] double memory_mb() const;
  /// Asks it to end (SIGTERM).
  void stop() const;

 private:
  [[nodiscard]] std::optional<ChildEnd> poll_told_end();
  void kill_and_close();

  pid_t pid_ = -1;  ///< -1: ended
  int descriptor_ = -1;
  bool is_told_ = false;  ///< its end is read from the descriptor
};

/// While it lives, SIGINT, SIGTERM and SIGHUP do not end this program but are remembered.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] bool requested() const { return signal() != 0; }
  /// The last one that came; 0: none.
  [[nodiscard]] int signal() const;
};

}  // namespace saccade
