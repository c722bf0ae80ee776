#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace saccade {

/// No progress is shown anywhere from now on (`-q`), or it is again.
void set_progress_quiet(bool quiet);

/// Shows a line on stderr, unless progress is not shown.
void show_notice(const std::string& line);

/// Shows "warning: <line>" on stderr, quiet or not, for what a result lacks; the same line once in a
/// process. Thread-safe.
void show_warning(const std::string& line);

/// What one line of progress says.
struct ProgressState {
  std::string label;
  std::string unit;  ///< plural
  std::uint64_t done = 0;
  std::uint64_t total = 0;  ///< 0 = unknown
  double elapsed_s = 0;
  bool with_bar = false;
  bool finished = false;
  std::uint64_t resumed = 0;  ///< of `done`: by an earlier program, not in elapsed_s
};

/// "simulating: [####....]  50 %, 1.2 M events/s, 3.4 s left".
[[nodiscard]] std::string progress_text(const ProgressState& state);

/// Shows on stderr how far a piece of work is: a bar with rate and time left, redrawn in place, on
/// a terminal; otherwise plain lines at growing intervals (after 5 s, then at each doubling of the
/// time), so that logs stay short. add() is thread-safe and cheap enough for every batch.
class Progress {
 public:
  /// `total`: units of the whole work, 0 when unknown; `unit`: their plural ("events"); `resumed`:
  /// units that are done already.
  Progress(std::string label, std::uint64_t total, std::string unit, std::uint64_t resumed = 0);
  ~Progress();  ///< finishes
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(std::uint64_t units);
  /// Shows a line of text above the bar, quiet or not: for what went wrong with a part of the work.
  void report(const std::string& line);
  /// Shows the final state: what was done, how long it took, at which rate. Once.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show(Clock::time_point now, bool last) const;

  const std::string label_;
  const std::uint64_t total_;
  const std::string unit_;
  const std::uint64_t resumed_;
  const bool terminal_;
  const Clock::time_point start_;
  std::mutex mutex_;
  std::uint64_t done_;
  Clock::time_point next_;
  bool finished_ = false;
};

}  // namespace saccade
