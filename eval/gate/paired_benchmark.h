#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace saccade {

/// Two programs on the same work in turn.
struct PairedBenchmark {
  std::filesystem::path first;
  std::filesystem::path second;
  std::vector<std::string> arguments;  ///< of both
  int repeats = 10;                    ///< timed runs of each, >= 2
};

/// What each run took [s]; those of one index were one after the other, in either order.
struct PairedTimes {
  std::vector<double> first_s;
  std::vector<double> second_s;
};

/// Whose turn it is: A B B A A B B A ..., so that a machine that grows slower or faster weighs on
/// both alike. `second`: whether it is the second program's.
struct Repetition {
  bool second;
  bool timed;  ///< the first run of each fills the caches and is not
};
[[nodiscard]] std::vector<Repetition> repetition_order(int repeats);

/// Runs them, one process at a time, and says how long each took: where the arguments are those of
/// `saccade run`, wall_s of the timing.json that it wrote, which is the estimator's own clock and
/// leaves reading and writing out; else from start to end of the process. `before` hears of each
/// run. Throws InputError for a program that cannot be started, std::runtime_error where one fails
/// (with the end of what it printed) or on Ctrl-C.
[[nodiscard]] PairedTimes run_paired_benchmark(const PairedBenchmark& race,
                                 const std::function<void(const Repetition&)>& before);

}  // namespace saccade
