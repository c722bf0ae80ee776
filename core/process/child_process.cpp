#include "core/process/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

/// The system takes that long at most to end a process of another parent that has been killed.
constexpr int kKillTimeoutMs = 5000;

constexpr std::array kInterrupts{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t interrupted = 0;
std::array<struct sigaction, kInterrupts.size()> former_actions;

void remember(int signal) { interrupted = signal; }

/// What a child gets instead of what this program has.
class SpawnSetup {
 public:
  SpawnSetup(const std::filesystem::path& log, const std::filesystem::path& working_folder) {
    posix_spawn_file_actions_init(&files);
    if (!working_folder.empty())
      posix_spawn_file_actions_addchdir_np(&files, working_folder.c_str());
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

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// The high-water mark of a process and of all below it; 0 where there is none (any more).
double largest_memory_mb(pid_t pid) {
  const std::string folder = fmt::format("/proc/{}", pid);
  double largest = 0;
  std::ifstream status(folder + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) largest = std::strtod(line.c_str() + 6, nullptr) / 1024;
  std::ifstream children(fmt::format("{}/task/{}/children", folder, pid));
  for (pid_t child = 0; children >> child;) largest = std::max(largest, largest_memory_mb(child));
  return largest;
}

/// As the system wants a list of texts; valid as long as they are.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

std::string ChildEnd::text() const {
  if (signal == 0) return fmt::format("exit code {}", exit_code);
  return fmt::format("killed by signal {} ({})", signal, sigdescr_np(signal));
}

ChildEnd ChildEnd::of(int status, const rusage& usage) {
  ChildEnd end;
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024;
  return end;
}

void begin_log(const std::filesystem::path& log, const std::vector<std::string>& words) {
  std::ofstream stream(log, std::ios::app | std::ios::binary);
  stream << "$ " << shell_line(words) << "\n" << std::flush;
  if (!stream) fail_to_write(log, errno);
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& words, const std::filesystem::path& log,
                           const std::filesystem::path& working_folder) {
  begin_log(log, words);
  const SpawnSetup setup(log, working_folder);
  const int error = posix_spawnp(&pid_, program.c_str(), &setup.files, &setup.attributes,
                                 pointers_to(words).data(), environ);
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
    : pid_(std::exchange(other.pid_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      is_told_(other.is_told_) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  kill_and_close();
  pid_ = std::exchange(other.pid_, -1);
  descriptor_ = std::exchange(other.descriptor_, -1);
  is_told_ = other.is_told_;
  return *this;
}

std::optional<ChildEnd> ChildProcess::poll_end() {
  if (is_told_) return poll_told_end();
  int status = 0;
  rusage usage{};
  if (pid_ < 0 || wait4(pid_, &status, WNOHANG, &usage) != pid_) return std::nullopt;
  pid_ = -1;
  return ChildEnd::of(status, usage);
}

std::optional<ChildEnd> ChildProcess::poll_told_end() {
  if (pid_ < 0) return std::nullopt;
  pollfd told{descriptor_, POLLIN, 0};
  if (::poll(&told, 1, 0) <= 0) return std::nullopt;
  ChildEnd end;
  const ssize_t count = ::read(descriptor_, &end, sizeof(end));
  if (count < 0 && errno == EINTR) return std::nullopt;
  if (count != sizeof(end)) {
    // Its parent was killed, and it might go on for ever.
    ::kill(-pid_, SIGKILL);
    end = {};
    end.signal = SIGKILL;
  }
  pid_ = -1;
  return end;
}

double ChildProcess::memory_mb() const { return pid_ > 0 ? largest_memory_mb(pid_) : 0; }

void ChildProcess::stop() const {
  // The number of one whose end was told may be another's by now.
  pollfd told{descriptor_, POLLIN, 0};
  if (is_told_ && ::poll(&told, 1, 0) != 0) return;
  if (pid_ > 0) ::kill(-pid_, SIGTERM);
}

void ChildProcess::kill_and_close() {
  // One whose end was told, but not heard, is gone, and its number may be another's by now.
  if (pid_ > 0 && !(is_told_ && poll_told_end())) {
    ::kill(-pid_, SIGKILL);
    pollfd told{descriptor_, POLLIN, 0};
    if (is_told_)
      ::poll(&told, 1, kKillTimeoutMs);
    else
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
