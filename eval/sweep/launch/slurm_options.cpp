#include "eval/sweep/launch/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace saccade {

void describe(config::Fields& fields, SlurmOptions& options) {
  fields.value("options", options.options,
               "Options of sbatch for each task, one text each, such as --account=NAME, "
               "--partition=NAME, --time=MINUTES or --mem=MEGABYTES.");
  fields
      .value("jobs_per_task", options.jobs_per_task,
             "Jobs that one task of an array runs one after another. More reduce the overhead of "
             "Slurm for jobs of less than a second, and the parallelism.")
      .range(1, 10000);
  const bool all_options =
      std::all_of(options.options.begin(), options.options.end(),
                  [](const std::string& option) { return option.starts_with('-'); });
  fields.expect(all_options, "options", "must be options of sbatch, such as --account=NAME");
}

std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads) {
  std::vector<std::string> words{"--nodes=1", "--ntasks=1", "--no-requeue"};
  words.push_back(threads == 0 ? "--exclusive" : fmt::format("--cpus-per-task={}", threads));
  words.insert(words.end(), options.options.begin(), options.options.end());
  return words;
}

}  // namespace saccade
