#pragma once

#include "eval/sweep/launcher.h"

namespace saccade {

/// Child processes of this program on this machine.
class LocalLauncher : public Launcher {
 public:
  explicit LocalLauncher(std::filesystem::path program) : program_(std::move(program)) {}

  [[nodiscard]] bool run(std::span<const LaunchJob> jobs, int at_once,
                         const std::function<void(std::size_t, const LaunchResult&)>& on_end,
                         const std::function<void()>& on_wait) override;

 private:
  std::filesystem::path program_;
};

}  // namespace saccade
