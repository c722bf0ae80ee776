#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/io/run/method_class.h"
#include "eval/metrics/metrics.h"
#include "eval/metrics/outcome.h"
#include "eval/table/table.h"

namespace saccade {

/// A run as the leaderboard sees it. Those of one method on one sequence differ in the seed.
struct LeaderboardEntry {
  std::string method;
  std::string sequence;
  Metrics metrics = {};
  std::string problem = {};  ///< why the run came to nothing; empty where all is well
  std::string source = {};   ///< where somebody published the score; empty for a run
  std::string module = {};   ///< of `saccade run`
  std::optional<MethodClass> method_class = {};  ///< nullopt: not known
  int threads = 0;                               ///< 0: not known
};

/// What a method reached on a sequence.
struct LeaderboardScore {
  std::optional<PooledValue> value;  ///< over the seeds that have one and did not fail
  std::size_t runs = 0;
  std::size_t failed = 0;  ///< of these; of trajectories, all that did not succeed
  std::string problem;     ///< of the first of these
  std::string note;        ///< what the value does not say by itself

  /// A score that no failed run spoils.
  [[nodiscard]] bool complete() const { return value && failed == 0; }
};

struct LeaderboardRow {
  std::string method;
  std::string source;
  std::optional<MethodClass> method_class;
  std::set<int> threads;                  ///< of its runs, as far as they are known
  std::optional<double> realtime_factor;  ///< geometric mean over its runs that did not fail
  std::vector<LeaderboardScore> scores;   ///< by sequence
  std::optional<SuccessShare> success;    ///< of trajectories, over all runs
  /// Geometric mean over the sequences that it has; nullopt where a score is not above 0.
  std::optional<PooledValue> overall;
  std::size_t runs = 0, failed = 0;  ///< over all sequences
  std::size_t sequences = 0;         ///< that it was run over
  int rank = 0;                      ///< from 1 on within its class; 0: not ranked

  /// The share of its runs that did not fail.
  [[nodiscard]] double solved() const {
    return runs == 0 ? 0 : 1 - static_cast<double>(failed) / static_cast<double>(runs);
  }
};

/// The methods by one metric.
struct Leaderboard {
  std::string key;    ///< "trajectory.dt_rel_percent.mean"
  std::string label;  ///< "dt_rel, mean [%]", with the unit that people are shown
  double scale = 1;   ///< from a score to that unit
  bool higher_is_better = false;
  std::vector<std::string> sequences;  ///< in the order in which the entries name them
  std::vector<LeaderboardRow> rows;    ///< class by class, best first, those not ranked behind
};

/// Mean and 95 % interval: by the studentised bootstrap from kLeastForBootstrap values on
/// (eval/gate/bootstrap.h), below that by Student's t, mean +- t s / sqrt(n); a single value has
/// none. Contract: at least one, all finite.
[[nodiscard]] PooledValue pooled(std::span<const double> values);

/// One per metric that any of the entries has, in a fixed order, in the metric's own unit;
/// `trajectory.nees`, best at 6, as nees_factor(). An entry with a problem stands on the boards of
/// the metrics that other entries of its module have, or on those of trajectories where none has
/// any. On those of trajectories and on that of speed an entry whose
/// `success` is 0 has failed, too, so that a mean is one over successes and stands beside their
/// share. Scores are pooled over seeds as they are; over sequences, which differ in difficulty by
/// factors, as logarithms:
///   overall = exp(mean of ln score),  interval = exp(interval of the mean of ln score),
/// the interval from three sequences on. Ranked are the methods of a class among each other that
/// were run over all sequences of the class: first by the share of runs that did not fail, then by
/// the overall score. A class is known of a method when one of its entries states it.
[[nodiscard]] std::vector<Leaderboard> leaderboards(std::span<const LeaderboardEntry> entries);

/// Its scores times its scale; sequences have columns where there are few of them. The best of a
/// column within a class are bold.
[[nodiscard]] Table leaderboard_table(const Leaderboard& board);

}  // namespace saccade
