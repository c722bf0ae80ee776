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

/// The jobs of one sweep call in Slurm: pending, submitted or finished.
class SlurmJobs {
 public:
  SlurmJobs(std::span<const LaunchJob> jobs, const LaunchLimits& limits,
            const LauncherOptions& options, SlurmCluster& cluster,
            const LaunchCallbacks& callbacks);

  /// Adopts the jobs that earlier calls submitted, whether they are still queued or have ended.
  /// Arrays with a job whose inputs have changed are cancelled. Returns the number of adopted jobs.
  std::size_t adopt_submitted();
  /// Submits pending jobs as one array, as far as the limits permit. Throws InputError when Slurm
  /// rejects it and no submitted job could make room.
  void submit();
  /// Reports the jobs that ended by themselves.
  void collect_exits();
  /// Asks the queue for the state of the other jobs.
  void poll_queue();
  [[nodiscard]] bool all_finished() const;
  /// Cancels everything that was submitted, and waits until nothing of it runs.
  void cancel();

 private:
  using Clock = std::chrono::steady_clock;
  enum class State { kPending, kSubmitted, kFinished };
  struct Job {
    State state = State::kPending;
    std::size_t array = 0;
    std::size_t index = 0;  ///< in the array
    int attempts = 0;
    int request_factor = 1;                           ///< SlurmArrayJob's
    std::optional<Clock::time_point> not_before;      ///< it waits after it was lost
    std::optional<Clock::time_point> inactive_since;  ///< it left the queue
  };

  void adopt(std::size_t array);
  [[nodiscard]] bool is_outdated(const SlurmArray& array) const;
  [[nodiscard]] std::vector<std::size_t> in_state(State state) const;
  /// The pending jobs that may be submitted now and request the same as the first of them.
  [[nodiscard]] std::vector<std::size_t> next_of_one_request() const;
  [[nodiscard]] SlurmRequest request_of(std::size_t index) const;
  /// True where a job that exceeded its request is to be tried with twice as much.
  [[nodiscard]] bool retry_with_more(std::size_t index, const std::string& state);
  [[nodiscard]] std::vector<std::string> submitted_arrays() const;
  void cancel_arrays(const std::vector<std::string>& names);
  [[nodiscard]] SlurmArray write_array(const std::vector<std::size_t>& chosen) const;
  /// Determines the result of a job that left the queue. `state`: its last one in the queue.
  void resolve(std::size_t index, const std::string& state);
  void handle_lost(std::size_t index, const std::string& state);
  [[nodiscard]] bool first_unfinished_of_task(const Job& job) const;
  void finish_by_exit(std::size_t index, const SlurmExit& exit, const std::string& problem);
  void fail(std::size_t index, const std::string& problem);
  void finish(std::size_t index, const LaunchResult& result);
  void make_pending(Job& job);

  std::span<const LaunchJob> launches_;
  const LaunchLimits& limits_;
  const LauncherOptions& options_;
  SlurmCluster& cluster_;
  const LaunchCallbacks& callbacks_;
  std::vector<Job> jobs_;  ///< as launches_
  std::vector<SlurmArray> arrays_;
  int max_array_size_;
};

}  // namespace saccade
