#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/launch/slurm_array.h"
#include "eval/sweep/launch/slurm_cluster.h"

namespace saccade {

/// The jobs of one call on their way through Slurm: waiting to be submitted, queued, ended.
class SlurmJobs {
 public:
  SlurmJobs(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
            const LauncherOptions& options, SlurmCluster& cluster, const LaunchCallbacks& events);

  /// Takes over what earlier calls left in the queue, or what ended since. Arrays with a job whose
  /// inputs are others by now are cancelled. How many jobs were taken over.
  std::size_t take_over();
  /// Submits what waits as one array, as far as the limits allow. InputError when Slurm refuses it
  /// and nothing is queued that could make room.
  void submit();
  /// Tells of the jobs that ended by themselves.
  void collect();
  /// Asks the queue what became of the others.
  void look();
  [[nodiscard]] bool all_ended() const;
  /// Takes everything out of the queue, and waits until nothing of it runs.
  void cancel();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { kWaiting, kQueued, kEnded };
  struct Job {
    Stage stage = Stage::kWaiting;
    std::size_t batch = 0;
    std::size_t place = 0;  ///< in the batch
    int attempts = 0;
    std::optional<Clock::time_point> over_since;  ///< the queue has it no more
  };

  void adopt(std::size_t batch);
  [[nodiscard]] bool is_outdated(const SlurmArray& batch) const;
  [[nodiscard]] std::vector<std::size_t> in_stage(Stage stage) const;
  [[nodiscard]] std::vector<std::string> queued_arrays() const;
  void cancel_arrays(const std::vector<std::string>& arrays);
  [[nodiscard]] SlurmArray write_batch(const std::vector<std::size_t>& chosen) const;
  /// What became of a job whose task is over.
  void judge(std::size_t index, const std::string& state);
  void lose(std::size_t index, const std::string& state);
  [[nodiscard]] bool first_unfinished_of_task(const Job& job) const;
  void end_by_exit(std::size_t index, const SlurmExit& exit, const std::string& problem);
  void fail(std::size_t index, const std::string& problem);
  void end(std::size_t index, const LaunchResult& result);
  void wait_again(Job& job);

  std::span<const LaunchJob> launches_;
  const LaunchLimits& limits_;
  const LauncherOptions& options_;
  SlurmCluster& cluster_;
  const LaunchCallbacks& events_;
  std::vector<Job> jobs_;  ///< as launches_
  std::vector<SlurmArray> batches_;
  int largest_array_;
};

}  // namespace saccade
