#include "eval/sweep/launch/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace saccade {

void describe(config::Fields& fields, SlurmOptions& options) {
  fields.value("partition", options.partition,
               "Partition of the cluster. Empty: the cluster's default.");
  fields
      .value("time_limit_s", options.time_limit_s,
             "Time limit of one job, in seconds (Slurm rounds up to minutes). Default: that of the "
             "partition.")
      .above(0);
  fields
      .value("memory_mb", options.memory_mb,
             "Memory of one job, in megabytes. Default: that of the partition.")
      .range(1, 1e9);
  fields.value("options", options.options,
               "Further options of sbatch, one text each, such as --account=NAME.");
  fields
      .value("jobs_per_task", options.jobs_per_task,
             "Jobs that one task of an array runs one after another. More reduce the overhead of "
             "Slurm for jobs of less than a second, and the parallelism.")
      .range(1, 10000);
  fields
      .value("attempts", options.attempts,
             "How often a job is submitted at most whose node failed or whose script was killed.")
      .range(1, 100);
  fields
      .value(
          "file_lag_s", options.file_lag_s,
          "Delay, in seconds, until files written by a node are visible here. A job that left the "
          "queue counts as lost after this time without a result.")
      .range(0, 3600);
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
