#include "core/process/other_threads.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdlib>

namespace saccade {
namespace {

/// More threads than any machine of today runs at once for one program; those beyond go on.
constexpr std::size_t kMostThreads = 4096;
std::array<pid_t, kMostThreads> asked_threads;
std::size_t asked = 0;
std::atomic<std::size_t> held = 0;

void hold_this_thread(int) {
  ++held;
  for (;;) ::pause();
}

bool is_asked(pid_t thread) {
  const auto end = asked_threads.begin() + static_cast<std::ptrdiff_t>(asked);
  return std::find(asked_threads.begin(), end, thread) != end;
}

void ask(pid_t thread, int signal) {
  if (thread == 0 || thread == ::gettid() || asked == kMostThreads || is_asked(thread)) return;
  if (::syscall(SYS_tgkill, ::getpid(), thread, signal) == 0) asked_threads[asked++] = thread;
}

/// Whether there were any that had not been asked. Without opendir(), which takes memory.
bool ask_new_threads(int signal) {
  const int folder = ::open("/proc/self/task", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return false;
  const std::size_t before = asked;
  alignas(dirent64) std::array<char, 4096> entries;
  for (;;) {
    const ssize_t size = ::getdents64(folder, entries.data(), entries.size());
    if (size <= 0) break;
    for (ssize_t at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      ask(static_cast<pid_t>(std::atol(entry->d_name)), signal);
      at += entry->d_reclen;
    }
  }
  ::close(folder);
  return asked > before;
}

void wait_until_held() {
  constexpr timespec kMillisecond{0, 1'000'000};
  for (int ms = 0; ms < 200 && held < asked; ++ms) ::nanosleep(&kMillisecond, nullptr);
}

}  // namespace

void hold_other_threads() {
  // A signal that nothing else here uses.
  const int signal = SIGRTMIN + 5;
  struct sigaction action {};
  action.sa_handler = hold_this_thread;
  sigfillset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
  // A thread may have started another one before it was held.
  while (ask_new_threads(signal)) wait_until_held();
}

}  // namespace saccade
