#include "estimator/external/external_process.h"

#include <poll.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <fstream>
#include <optional>

#include "core/error.h"
#include "core/stopwatch.h"

namespace saccade {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWaitMs = 20;
/// How long the program may take to end after it was asked to.
constexpr double kPatienceS = 5;

/// Waits for the end, at most until `limit`, or until this program is to end; raises `memory_mb`.
std::optional<ChildEnd> wait_until(ChildProcess& process, Clock::time_point limit,
                                   const InterruptGuard* interrupt, double& memory_mb) {
  for (;;) {
    if (auto end = process.poll_end()) return end;
    memory_mb = std::max(memory_mb, process.memory_mb());
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit - Clock::now()).count();
    if (left <= 0 || (interrupt != nullptr && interrupt->requested())) return std::nullopt;
    pollfd ended{process.descriptor(), POLLIN, 0};
    ::poll(&ended, 1, static_cast<int>(std::min<std::int64_t>(left, kWaitMs)));
  }
}

/// What the system says of all its processes is exact, but counts this program's memory before the
/// start as theirs; what was looked at meanwhile is not.
double peak_memory_mb(const ChildEnd& end, double seen_mb) {
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  const bool is_theirs = end.peak_memory_mb > static_cast<double>(own.ru_maxrss) / 1024;
  return is_theirs ? end.peak_memory_mb : seen_mb;
}

Clock::time_point after(double seconds) {
  // A year is for ever; more could overflow the clock.
  constexpr double kForeverS = 3e7;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, kForeverS)));
}

}  // namespace

ExternalEnd run_external_program(const ExternalCall& call) {
  const InterruptGuard interrupt;
  const Stopwatch stopwatch;
  ChildProcess process(call.words.front(), call.words, call.log, call.working_folder);
  ExternalEnd result;
  double seen_mb = 0;
  std::optional<ChildEnd> end = wait_until(process, after(call.timeout_s), &interrupt, seen_mb);
  result.wall_s = stopwatch.seconds();
  if (!end) {
    result.timed_out = true;
    process.stop();
    end = wait_until(process, after(kPatienceS), nullptr, seen_mb);
  }
  if (interrupt.requested()) throw InputError(call.words.front(), "was interrupted");
  if (end) result.end = *end;
  result.peak_memory_mb = peak_memory_mb(result.end, seen_mb);
  return result;
}

std::string log_tail(const std::filesystem::path& log) {
  constexpr std::size_t kLines = 3;
  constexpr std::size_t kLongest = 200;  // of a line
  std::ifstream file(log);
  std::deque<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    if (line.starts_with("$ ")) {
      lines.clear();  // the words of the next repetition
      continue;
    }
    lines.push_back(line.substr(0, kLongest));
    if (lines.size() > kLines) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " / ") + line;
  return text;
}

}  // namespace saccade
