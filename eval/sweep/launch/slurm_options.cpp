#include "eval/sweep/launch/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace saccade {

void describe(config::Fields& fields, SlurmOptions& options) {
  fields.value("partition", options.partition, "of the cluster; empty: its default");
  fields.value("time_limit_s", options.time_limit_s, "of one job; default: the partition's")
      .above(0);
  fields.value("memory_mb", options.memory_mb, "of one job; default: the partition's")
      .range(1, 1e9);
  fields.value("options", options.options, "further options of sbatch, one text each");
  fields.value("jobs_per_task", options.jobs_per_task, "jobs that a task runs one after another")
      .range(1, 10000);
  fields.value("attempts", options.attempts, "for a job whose node or script was lost")
      .range(1, 100);
  fields
      .value("file_lag_s", options.file_lag_s,
             "until a file that a node wrote is surely seen by others")
      .range(0, 3600);
  fields.value("arrays_of", options.arrays_of, "tasks at most in an array; 0: what Slurm takes")
      .range(0, 1e6);
  const bool all_options =
      std::all_of(options.options.begin(), options.options.end(),
                  [](const std::string& option) { return option.starts_with('-'); });
  fields.expect(all_options, "options", "must be options of sbatch, such as --account=NAME");
}

std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads) {
  std::vector<std::string> words{"--nodes=1", "--ntasks=1", "--no-requeue"};
  words.push_back(threads == 0 ? "--exclusive" : fmt::format("--cpus-per-task={}", threads));
  if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
  if (options.time_limit_s) {
    const double seconds = std::ceil(*options.time_limit_s * options.jobs_per_task);
    words.push_back(fmt::format("--time=0:{:.0f}", seconds));
  }
  if (options.memory_mb) words.push_back(fmt::format("--mem={}M", *options.memory_mb));
  words.insert(words.end(), options.options.begin(), options.options.end());
  return words;
}

}  // namespace saccade
