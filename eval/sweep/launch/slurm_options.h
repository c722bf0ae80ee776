#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/config/fields.h"

namespace saccade {

/// What a sweep requests from Slurm for each of its jobs. Empty values mean the cluster's defaults.
struct SlurmOptions {
  std::string partition;
  std::optional<double> time_limit_s;
  std::optional<int> memory_mb;
  std::vector<std::string> options;  ///< come after all others
  int jobs_per_task = 1;
  int attempts = 3;
  double file_lag_s = 30;
  int max_array_size = 0;  ///< tasks; 0: Slurm's MaxArraySize
};

void describe(config::Fields& fields, SlurmOptions& options);

/// These as options of sbatch, for tasks of `threads` cores (0: a whole node).
[[nodiscard]] std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads);

}  // namespace saccade
