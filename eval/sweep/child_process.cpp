#include "eval/sweep/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/shell.h"

namespace saccade {
namespace {

constexpr std::array kInterrupts{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t interrupted = 0;
std::array<struct sigaction, kInterrupts.size()> former_actions;

void remember(int signal) { interrupted = signal; }

/// What a child gets instead of what this program has.
class SpawnSetup {
 public:
  explicit SpawnSetup(const std::filesystem::path& log) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0666);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes, &all);
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

void append(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::app | std::ios::binary);
  stream << text << std::flush;
  if (!stream) fail_to_write(file, errno);
}

ChildEnd end_of(int status) {
  if (WIFEXITED(status)) return {WEXITSTATUS(status), 0};
  return {-1, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
}

}  // namespace

std::string ChildEnd::text() const {
  if (signal == 0) return fmt::format("exit code {}", exit_code);
  return fmt::format("killed by signal {} ({})", signal, sigdescr_np(signal));
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& words,
                           const std::filesystem::path& log) {
  append(log, "$ " + shell_line(words) + "\n");
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const SpawnSetup setup(log);
  const int error =
      posix_spawn(&pid_, program.c_str(), &setup.files, &setup.attributes, argv.data(), environ);
  if (error != 0)
    throw InputError(program.string(),
                     fmt::format("cannot be started: {}", std::generic_category().message(error)));
  // The header of glibc 2.36 declares pidfd_open() for C alone.
  descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (descriptor_ < 0) {
    const int reason = errno;
    kill_and_close();
    throw InputError(program.string(), fmt::format("cannot be waited for: {}",
                                                   std::generic_category().message(reason)));
  }
}

ChildProcess::~ChildProcess() { kill_and_close(); }

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), descriptor_(std::exchange(other.descriptor_, -1)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  kill_and_close();
  pid_ = std::exchange(other.pid_, -1);
  descriptor_ = std::exchange(other.descriptor_, -1);
  return *this;
}

std::optional<ChildEnd> ChildProcess::poll_end() {
  int status = 0;
  if (pid_ < 0 || waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  pid_ = -1;
  return end_of(status);
}

void ChildProcess::stop() const {
  if (pid_ > 0) ::kill(-pid_, SIGTERM);
}

void ChildProcess::kill_and_close() {
  if (pid_ > 0) {
    ::kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

InterruptGuard::InterruptGuard() {
  interrupted = 0;
  struct sigaction action {};
  action.sa_handler = remember;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kInterrupts.size(); ++i) {
    sigaction(kInterrupts[i], nullptr, &former_actions[i]);
    // nohup has SIGHUP ignored, and so it stays.
    if (former_actions[i].sa_handler != SIG_IGN) sigaction(kInterrupts[i], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t i = 0; i < kInterrupts.size(); ++i)
    sigaction(kInterrupts[i], &former_actions[i], nullptr);
}

int InterruptGuard::signal() const { return interrupted; }

}  // namespace saccade
