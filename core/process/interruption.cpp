#include "core/process/interruption.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>
#include <thread>

#include "core/check.h"
#include "core/io/files/resumable_folder.h"
#include "core/io/files/temporary_paths.h"

namespace saccade {
namespace {

struct NamedSignal {
  int number;
  const char* name;
};
constexpr std::array<NamedSignal, 3> kEndingSignals{
    {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}};

int signal_pipe[2] = {-1, -1};

/// Almost nothing may be called here, so that a thread that waits does the work.
void hand_to_thread(int signal) {
  const int before = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const ssize_t written = ::write(signal_pipe[1], &byte, 1);
  errno = before;
}

[[noreturn]] void end_by(int signal) {
  std::string line = "saccade: interrupted";
  for (const NamedSignal& known : kEndingSignals)
    if (known.number == signal) line += std::string(" (") + known.name + ")";
  line += ResumableFolder::is_any_unfinished() ? "; the same command goes on where it stopped\n"
                                               : "; nothing unfinished is left behind\n";
  remove_temporary_paths();
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
  constexpr int kEndedBySignal = 128;
  ::_exit(kEndedBySignal + signal);
}

}  // namespace

void end_on_interruption() {
  SACCADE_CHECK(::pipe2(signal_pipe, O_CLOEXEC) == 0);
  std::thread([] {
    unsigned char signal = 0;
    while (::read(signal_pipe[0], &signal, 1) != 1) {
    }
    end_by(signal);
  }).detach();
  struct sigaction action {};
  action.sa_handler = hand_to_thread;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const NamedSignal& known : kEndingSignals) {
    struct sigaction former {};
    sigaction(known.number, nullptr, &former);
    if (former.sa_handler != SIG_IGN) sigaction(known.number, &action, nullptr);
  }
}

}  // namespace saccade
