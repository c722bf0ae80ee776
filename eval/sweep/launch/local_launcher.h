#pragma once

#include "eval/sweep/launch/launcher.h"

namespace saccade {

/// Child processes of this program on this machine.
class LocalLauncher : public Launcher {
 public:
  explicit LocalLauncher(std::filesystem::path program) : program_(std::move(program)) {}

  [[nodiscard]] bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                         const LaunchCallbacks& callbacks) override;
  /// As many as their threads fit the cores.
  [[nodiscard]] int default_parallel_jobs(int threads) const override;

 private:
  std::filesystem::path program_;
};

}  // namespace saccade
