#include "eval/sweep/launch/slurm_options.h"

#include <fmt/format.h>

namespace saccade {

std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads) {
  std::vector<std::string> words{"--nodes=1", "--ntasks=1", "--no-requeue"};
  words.push_back(threads == 0 ? "--exclusive" : fmt::format("--cpus-per-task={}", threads));
  words.insert(words.end(), options.options.begin(), options.options.end());
  return words;
}

}  // namespace saccade
