#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/config/fields.h"

namespace saccade {

/// What a sweep asks of Slurm for each of its jobs; nothing for what the cluster's defaults give.
struct SlurmOptions {
  std::string partition;
  std::optional<double> time_limit_s;  ///< of one job
  std::optional<int> memory_mb;        ///< of one job
  std::vector<std::string> options;    ///< of sbatch, after all others: "--account=vision"
  int jobs_per_task = 1;               ///< run one after another by one task of an array
  int attempts = 3;                    ///< for a job that was lost through no fault of its own
  double file_lag_s = 30;              ///< until files of a node that ended are seen here
  int arrays_of = 0;                   ///< tasks at most in an array; 0: as many as Slurm takes
};

void describe(config::Fields& fields, SlurmOptions& options);

/// The options of sbatch that say so, for tasks of `threads` cores (0: a whole machine).
[[nodiscard]] std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads);

}  // namespace saccade
