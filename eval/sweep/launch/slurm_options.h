#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// What a task may use. Without a value the cluster's default holds.
struct SlurmRequest {
  std::optional<double> minutes;
  std::optional<double> memory_mb;

  [[nodiscard]] bool operator==(const SlurmRequest&) const = default;
  /// Twice as much of what is limited.
  [[nodiscard]] SlurmRequest doubled() const;
};

/// What a sweep requests from Slurm for its jobs.
struct SlurmOptions {
  std::vector<std::string> options;  ///< come after all others
  int jobs_per_task = 1;             ///< that a task of an array runs one after another
  SlurmRequest request;  ///< of every task; one that exceeds it is tried with twice that
  /// The first job of each kind runs alone, and what it took becomes the request of the others.
  bool pilot = false;
  /// Image of Apptainer in which the jobs run, with `saccade` on its search path; empty: none.
  std::filesystem::path container;
  /// Delay until files that a node wrote are visible here: half of NFS's longest attribute cache.
  double file_lag_s = 30;
  double backoff_s = 10;   ///< before a lost job is submitted again; doubles with every attempt
  int max_array_size = 0;  ///< tasks; 0: Slurm's MaxArraySize
};

/// These as options of sbatch, for tasks of `threads` cores (0: a whole node) that request this.
[[nodiscard]] std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads,
                                                      const SlurmRequest& request);

/// The request for jobs like one that took so much: a margin above it, rounded up to a step of the
/// square root of 2, so that jobs of about one size stand in one array.
[[nodiscard]] SlurmRequest request_like(double wall_s, const std::optional<double>& memory_mb);

}  // namespace saccade
