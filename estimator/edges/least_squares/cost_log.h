#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/stopwatch.h"

namespace saccade {

/// An iteration of a solver; the first is the start.
struct SolverIteration {
  double cost = 0;
  double seconds = 0;  ///< since the solver began
};

/// What a solver did.
struct SolverSummary {
  std::vector<SolverIteration> iterations;
  bool is_usable =
      false;  ///< false: the problem has no value, or no step could be found, and nothing is changed
};

/// One iteration of a refinement.
struct IterationCost {
  int round = 0;  ///< costs of different rounds, which see different data, are no sequence
  int iteration = 0;
  double cost = 0;
  double seconds = 0;  ///< since the refinement began, without reading files
};

/// The costs of a refinement that begins now, iteration by iteration.
class CostLog {
 public:
  /// Since the refinement began [s].
  [[nodiscard]] double now_s() const { return stopwatch_.seconds(); }
  /// Appends the iterations of a round whose adjustment began at `start_s`.
  void add_round(std::span<const SolverIteration> iterations, double start_s);
  /// Appends what independent problems of one view cost together, before and after; a round.
  void add_view(double before, double after, double now_s) {
    steps_.push_back({rounds_, 0, before, 0});
    steps_.push_back({rounds_++, 1, after, now_s});
  }
  [[nodiscard]] const std::vector<IterationCost>& steps() const { return steps_; }
  [[nodiscard]] int rounds() const { return rounds_; }
  /// cost.csv: round, iteration, cost, seconds.
  void save(const std::filesystem::path& file) const;

 private:
  Stopwatch stopwatch_;
  std::vector<IterationCost> steps_;
  int rounds_ = 0;
};

}  // namespace saccade
