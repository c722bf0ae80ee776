#pragma once

#include <string>
#include <vector>

namespace saccade {

/// What a sweep requests from Slurm for its jobs.
struct SlurmOptions {
  std::vector<std::string> options;  ///< come after all others
  int jobs_per_task = 1;             ///< that a task of an array runs one after another
  /// Delay until files that a node wrote are visible here: half of NFS's longest attribute cache.
  double file_lag_s = 30;
  int max_array_size = 0;  ///< tasks; 0: Slurm's MaxArraySize
};

/// These as options of sbatch, for tasks of `threads` cores (0: a whole node).
[[nodiscard]] std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads);

}  // namespace saccade
