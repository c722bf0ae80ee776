#include "core/process/forked_call.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
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
#include <limits>
#include <mutex>
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

double taken_cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// For the next call, beside what was taken by those before.
void limit_this_process(const ForkLimits& limits) {
  const double cpu_s = std::ceil(taken_cpu_s() + std::max(limits.cpu_s, 1.0));
  limit_resource(RLIMIT_CPU, static_cast<std::uint64_t>(cpu_s));
  if (kMemoryCanBeLimited)
    limit_resource(RLIMIT_AS, address_space_bytes() + (limits.memory_mb << 20U));
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    // Who reads may have died, which is no reason to die as well.
    const ssize_t count = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// A message is its kind, its size and its bytes.
bool send_message(int descriptor, char kind, std::string_view bytes) {
  std::array<char, kForkedHead> head{kind};
  const std::uint64_t size = bytes.size();
  std::memcpy(head.data() + 1, &size, sizeof(size));
  return write_all(descriptor, {head.data(), head.size()}) && write_all(descriptor, bytes);
}

/// When the other end must have answered.
class Deadline {
 public:
  explicit Deadline(double wall_s) : end_(Clock::now() + std::chrono::duration<double>(wall_s)) {}

  [[nodiscard]] double left_s() const {
    return std::chrono::duration<double>(end_ - Clock::now()).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::time_point<Clock, std::chrono::duration<double>> end_;
};

enum class Received { kAll, kEnd, kLate };

Received receive(int descriptor, char* bytes, std::size_t count, const Deadline& deadline) {
  while (count > 0) {
    const double left_s = deadline.left_s();
    if (left_s <= 0) return Received::kLate;
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(std::ceil(1e3 * std::min(left_s, 1e6))));
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t got = ::read(descriptor, bytes, count);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Received::kEnd;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return Received::kAll;
}

struct Message {
  char kind = 0;
  std::string bytes;
};

Received receive_message(int descriptor, const Deadline& deadline, Message& message) {
  std::array<char, kForkedHead> head{};
  const Received begin = receive(descriptor, head.data(), head.size(), deadline);
  if (begin != Received::kAll) return begin;
  message.kind = head[0];
  std::uint64_t size = 0;
  std::memcpy(&size, head.data() + 1, sizeof(size));
  message.bytes.clear();
  // In pieces, so that a size gone wrong does not ask for all memory.
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 24U;
  for (std::uint64_t done = 0; done < size; done = message.bytes.size()) {
    const std::uint64_t piece = std::min(size - done, kPiece);
    message.bytes.resize(done + piece);
    const Received received = receive(descriptor, message.bytes.data() + done, piece, deadline);
    if (received != Received::kAll) return received;
  }
  return Received::kAll;
}

bool answer(const ForkedWorker::Work& work, const std::string& request, const ForkLimits& limits,
            int socket) {
  try {
    return send_message(socket, kForkedFine, work(request));
  } catch (const std::bad_alloc&) {
    return send_message(socket, kForkedProblem, memory_problem(limits));
  } catch (const std::exception& error) {
    return send_message(socket, kForkedProblem, error.what());
  } catch (...) {
    return send_message(socket, kForkedProblem, "failed without saying why");
  }
}

/// All that the copy of this process does. No exception may lead it into what the process itself
/// would do next: it ends by a signal, of which the process is told.
[[noreturn]] void run_as_child(const ForkedWorker::Work& work, const ForkLimits& limits,
                               pid_t parent, int socket) noexcept {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU})
    std::signal(signal, SIG_DFL);
  // Ctrl-C is the other process's to answer, and this one ends with it.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere >= 0)
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  limit_resource(RLIMIT_CORE, 0);
  const Deadline never(std::numeric_limits<double>::infinity());
  for (Message request; receive_message(socket, never, request) == Received::kAll;) {
    limit_this_process(limits);
    if (!answer(work, request.bytes, limits, socket)) _exit(1);
  }
  _exit(0);
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

ForkedResult dead(std::string problem) { return {{}, std::move(problem), true}; }

/// Of a process that ended without an answer.
ForkedResult end_of(int status, const ForkLimits& limits) {
  if (!WIFSIGNALED(status))
    return dead(fmt::format("ended early (exit code {})", WEXITSTATUS(status)));
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) return dead(fmt::format("took more than {} s", limits.cpu_s));
  return dead(fmt::format("crashed ({})", sigdescr_np(signal)));
}

[[noreturn]] void fail_to_fork(const char* what) {
  throw InputError("a process of its own",
                   fmt::format("{}: {}", what, std::generic_category().message(errno)));
}

/// A copy that is made between another's socket and its fork would hold its ends open.
std::mutex& fork_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

class ForkedWorker::Child {
 public:
  Child(const Work& work, const ForkLimits& limits) {
    const std::lock_guard lock(fork_mutex());
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      fail_to_fork("cannot be connected");
    socket_.emplace(ends[0]);
    const Descriptor other(ends[1]);
    std::fflush(nullptr);  // or the copy would hold, and might print, what is still buffered
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ < 0) fail_to_fork("cannot be started");
    if (process_ == 0) run_as_child(work, limits, parent, other.number());
  }
  ~Child() {
    if (process_ <= 0) return;
    kill();
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool ask(const std::string& request) const {
    return send_message(socket_->number(), kForkedFine, request);
  }
  [[nodiscard]] Received hear(double wall_s, Message& message) const {
    return receive_message(socket_->number(), Deadline(wall_s), message);
  }
  void kill() const { ::kill(process_, SIGKILL); }
  /// Its status, once it has ended.
  int wait() { return wait_for(std::exchange(process_, 0)); }

 private:
  pid_t process_ = 0;
  std::optional<Descriptor> socket_;
};

ForkedWorker::ForkedWorker(Work work, const ForkLimits& limits)
    : work_(std::move(work)), limits_(limits), child_(std::make_shared<Child>(work_, limits_)) {}
ForkedWorker::~ForkedWorker() = default;

void ForkedWorker::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  if (child_) child_->kill();
}

ForkedResult ForkedWorker::call(const std::string& request) {
  std::shared_ptr<Child> child;
  {
    const std::lock_guard lock(mutex_);
    if (is_stopped_) return dead("was stopped");
    if (!child_) child_ = std::make_shared<Child>(work_, limits_);
    child = child_;
  }
  Message message;
  const Received received =
      child->ask(request) ? child->hear(limits_.wall_s, message) : Received::kEnd;
  if (received == Received::kAll) {
    if (message.kind == kForkedFine) return {std::move(message.bytes), {}, false};
    return {{}, std::move(message.bytes), false};
  }
  {
    const std::lock_guard lock(mutex_);
    child_.reset();  // from here on stop() does not know its number, which may be given anew
  }
  if (received == Received::kLate) child->kill();
  const int status = child->wait();
  return received == Received::kLate ? dead(fmt::format("took more than {} s", limits_.wall_s))
                                     : end_of(status, limits_);
}

ForkedResult call_in_child(const std::function<std::string()>& work, const ForkLimits& limits) {
  return ForkedWorker([&work](const std::string&) { return work(); }, limits).call({});
}

}  // namespace saccade
