#pragma once

#include <chrono>

namespace saccade {

/// Adds its lifetime to a sum of seconds.
class StageClock {
 public:
  explicit StageClock(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~StageClock() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

}  // namespace saccade
