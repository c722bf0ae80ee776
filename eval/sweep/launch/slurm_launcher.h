#pragma once

#include <chrono>
#include <memory>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/launch/slurm_cluster.h"

namespace saccade {

/// Job arrays of Slurm, on nodes that see the same files under the same paths. Submitted jobs
/// outlive this program: after SIGKILL and SIGHUP they continue, and the next call adopts them;
/// SIGINT and SIGTERM cancel them. A job whose node failed or whose script was killed is submitted
/// again after a while, one that exceeded the time or memory that
/// was requested for it with twice as much, up to three times in all.
class SlurmLauncher : public Launcher {
 public:
  /// `period`: between two checks for results; the queue is polled every five periods.
  SlurmLauncher(LauncherOptions options, std::unique_ptr<SlurmCluster> cluster,
                std::chrono::milliseconds period = std::chrono::milliseconds(200))
      : options_(std::move(options)), cluster_(std::move(cluster)), period_(period) {}

  [[nodiscard]] bool run(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
                         const LaunchCallbacks& callbacks) override;
  /// Unlimited: Slurm decides.
  [[nodiscard]] int default_parallel_jobs(int threads) const override;
  [[nodiscard]] std::string environment() const override;
  [[nodiscard]] bool wants_costs() const override { return options_.slurm.pilot; }

 private:
  LauncherOptions options_;
  std::unique_ptr<SlurmCluster> cluster_;
  std::chrono::milliseconds period_;
};

}  // namespace saccade
