#pragma once

#include <chrono>

namespace saccade {

/// Wall time of one piece of work. The one clock of the project: it never runs backwards.
class Stopwatch {
 public:
  /// Seconds since it was made.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Adds its lifetime to a sum of seconds, as of the stages in timing.json.
class ScopedTimer {
 public:
  explicit ScopedTimer(double& seconds) : seconds_(seconds) {}
  ~ScopedTimer() { seconds_ += stopwatch_.seconds(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& seconds_;
  Stopwatch stopwatch_;
};

}  // namespace saccade
