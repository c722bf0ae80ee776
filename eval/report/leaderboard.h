#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/metrics/metrics.h"
#include "eval/table/table.h"

namespace saccade {

/// A scored run as the leaderboard sees it. Those of one method on one sequence differ in the seed.
struct LeaderboardEntry {
  std::string method;
  std::string sequence;
  Metrics metrics;
  std::string problem;  ///< why the run came to nothing; empty where all is well
  std::string source;   ///< where somebody published the score; empty for a run
};

/// What a method reached on a sequence.
struct LeaderboardScore {
  std::optional<PooledValue> value;  ///< over the seeds that have one
  std::size_t failed = 0;            ///< runs that came to nothing
  std::string problem;               ///< of the first of these
  std::string note;                  ///< what the value does not say by itself

  /// A score that no failed run spoils.
  [[nodiscard]] bool complete() const { return value && failed == 0; }
};

struct LeaderboardRow {
  std::string method;
  std::string source;
  std::vector<LeaderboardScore> scores;  ///< by sequence
  /// Geometric mean over the sequences that it has; nullopt where a score is not above 0.
  std::optional<PooledValue> overall;
  std::size_t complete = 0;  ///< sequences with a complete score
  int rank = 0;              ///< from 1 on among those that are complete; 0: not ranked
};

/// The methods by one metric.
struct Leaderboard {
  std::string key;    ///< "trajectory.dt_rel_percent.mean"
  std::string label;  ///< "dt_rel, mean [%]", with the unit that people are shown
  double scale = 1;   ///< from a score to that unit
  bool higher_is_better = false;
  std::vector<std::string> sequences;  ///< in the order in which the entries name them
  std::vector<LeaderboardRow> rows;    ///< best first, those that lack sequences behind
};

/// Mean and 95 % interval: by the studentised bootstrap from kLeastForBootstrap values on
/// (eval/gate/bootstrap.h), below that by Student's t, mean +- t s / sqrt(n); a single value has
/// none. Contract: at least one, all finite.
[[nodiscard]] PooledValue pooled(std::span<const double> values);

/// One per metric that any of the entries has, in a fixed order, in the metric's own unit;
/// `trajectory.nees`, best at 6, as nees_factor(); runs that came to nothing stand in those of
/// trajectories. Scores are pooled over seeds as they are; over sequences, which differ in
/// difficulty by factors, as logarithms:
///   overall = exp(mean of ln score),  interval = exp(interval of the mean of ln score),
/// the interval from three sequences on.
[[nodiscard]] std::vector<Leaderboard> leaderboards(std::span<const LeaderboardEntry> entries);

/// Its scores times its scale.
[[nodiscard]] Table leaderboard_table(const Leaderboard& board);

}  // namespace saccade
