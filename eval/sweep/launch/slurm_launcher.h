#pragma once

#include <chrono>
#include <memory>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/launch/slurm_cluster.h"

namespace saccade {

/// Arrays of Slurm, whose nodes see the same files under the same paths. What is queued or running
/// outlives this program: SIGKILL and SIGHUP leave it there, and the next call takes it over;
/// SIGINT and SIGTERM cancel it. A job whose node or script was lost is submitted again, `attempts`
/// times in all.
class SlurmLauncher : public Launcher {
 public:
  /// `pace`: between two looks for results; the queue is asked at a fifth of it.
  SlurmLauncher(LauncherOptions options, std::unique_ptr<SlurmCluster> cluster,
                std::chrono::milliseconds pace = std::chrono::milliseconds(200))
      : options_(std::move(options)), cluster_(std::move(cluster)), pace_(pace) {}

  [[nodiscard]] bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                         const LaunchCallbacks& events) override;
  /// As many as the cluster has room for.
  [[nodiscard]] int default_parallel_jobs(int threads) const override;

 private:
  LauncherOptions options_;
  std::unique_ptr<SlurmCluster> cluster_;
  std::chrono::milliseconds pace_;
};

}  // namespace saccade
