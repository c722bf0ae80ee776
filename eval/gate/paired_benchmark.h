#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace saccade {

/// Two programs that are timed on the same work, alternately.
struct PairedBenchmark {
  std::filesystem::path first;
  std::filesystem::path second;
  std::vector<std::string> arguments;  ///< of both
  int repeats = 10;                    ///< timed repetitions of each, >= 2
};

/// Wall time of each timed repetition [s]. Times of equal index form a pair: they were measured
/// directly after each other, in either order.
struct PairedTimes {
  std::vector<double> first_s;
  std::vector<double> second_s;
};

/// One run of one of the two programs.
struct Repetition {
  bool second;  ///< of the second program
  bool timed;   ///< false for the warm-up, the first run of each, which fills the caches
};

/// The order of the runs after the warm-up is A B B A A B B A ..., so that a slow drift of the
/// machine's speed affects both programs equally. `repeats` >= 2.
[[nodiscard]] std::vector<Repetition> repetition_order(int repeats);

/// Runs all repetitions, one process at a time. Where the arguments are those of `saccade run`, the
/// time is wall_s of the timing.json that it writes, which excludes reading and writing files; else
/// it is that of the process from start to end. `before` is called before each repetition. Throws
/// InputError for a program that cannot be started, std::runtime_error for one that fails (with the
/// end of its output) and for Ctrl-C.
[[nodiscard]] PairedTimes run_paired_benchmark(
    const PairedBenchmark& benchmark, const std::function<void(const Repetition&)>& before);

}  // namespace saccade
