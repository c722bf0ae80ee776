#include "core/process/forked_call.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace saccade {
namespace {

constexpr char kForkedFine = 'f';
constexpr char kForkedProblem = 'p';
constexpr std::size_t kForkedHead = 1 + sizeof(std::uint64_t);

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryCanBeLimited = false;
#else
constexpr bool kMemoryCanBeLimited = true;
#endif

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

std::string memory_problem(const ForkLimits& limits) {
  return fmt::format("takes more than {} MB of memory", limits.memory_mb);
}

void limit_resource(__rlimit_resource resource, std::uint64_t most) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, most);
  setrlimit(resource, &limit);
}

std::uint64_t address_space_bytes() {
  std::ifstream stream("/proc/self/statm");
  std::uint64_t pages = 0;
  stream >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit_this_process(const ForkLimits& limits) {
  limit_resource(RLIMIT_CORE, 0);
  limit_resource(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(std::max(limits.cpu_s, 1.0))));
  if (kMemoryCanBeLimited)
    limit_resource(RLIMIT_AS, address_space_bytes() + (limits.memory_mb << 20U));
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool send_answer(int descriptor, char kind, std::string_view bytes) {
  std::array<char, kForkedHead> head{kind};
  const std::uint64_t size = bytes.size();
  std::memcpy(head.data() + 1, &size, sizeof(size));
  return write_all(descriptor, {head.data(), head.size()}) && write_all(descriptor, bytes);
}

/// All that the copy of this process does.
[[noreturn]] void run_as_child(const std::function<std::string()>& work, const ForkLimits& limits,
                               pid_t parent, int answer) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU})
    std::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  limit_this_process(limits);
  bool sent = false;
  try {
    sent = send_answer(answer, kForkedFine, work());
  } catch (const std::bad_alloc&) {
    sent = send_answer(answer, kForkedProblem, memory_problem(limits));
  } catch (const std::exception& error) {
    sent = send_answer(answer, kForkedProblem, error.what());
  } catch (...) {
    sent = send_answer(answer, kForkedProblem, "failed without saying why");
  }
  _exit(sent ? 0 : 1);
}

/// Everything until the other end closes; nullopt when that takes too long.
std::optional<std::string> read_until(int descriptor, double wall_s) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(wall_s);
  std::string bytes;
  std::array<char, std::size_t{1} << 16U> buffer;
  for (;;) {
    const double left_s = std::chrono::duration<double>(end - Clock::now()).count();
    if (left_s <= 0) return std::nullopt;
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(std::ceil(1e3 * std::min(left_s, 1e6))));
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

ForkedResult dead(std::string problem) { return {{}, std::move(problem), true}; }

ForkedResult result_of(std::string answer, int status, const ForkLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return dead(fmt::format("took more than {} s", limits.cpu_s));
    return dead(fmt::format("crashed ({})", sigdescr_np(signal)));
  }
  std::uint64_t size = 0;
  if (answer.size() >= kForkedHead) std::memcpy(&size, answer.data() + 1, sizeof(size));
  if (answer.size() < kForkedHead || answer.size() - kForkedHead != size)
    return dead(fmt::format("ended early (exit code {})", WEXITSTATUS(status)));
  const bool is_fine = answer.front() == kForkedFine;
  answer.erase(0, kForkedHead);
  return is_fine ? ForkedResult{std::move(answer), {}, false}
                 : ForkedResult{{}, std::move(answer), false};
}

}  // namespace

ForkedResult call_in_child(const std::function<std::string()>& work, const ForkLimits& limits) {
  const auto fail = [](const char* what) {
    throw InputError("a process of its own",
                     fmt::format("{}: {}", what, std::generic_category().message(errno)));
  };
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot be connected");
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  std::fflush(nullptr);  // or the copy would hold, and might print, what is still buffered
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) fail("cannot be started");
  if (child == 0) run_as_child(work, limits, parent, writing.number());
  writing.close();
  std::optional<std::string> answer = read_until(reading.number(), limits.wall_s);
  if (!answer) ::kill(child, SIGKILL);
  const int status = wait_for(child);
  if (!answer) return dead(fmt::format("took more than {} s", limits.wall_s));
  return result_of(std::move(*answer), status, limits);
}

}  // namespace saccade
