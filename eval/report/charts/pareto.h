#pragma once

#include <string>
#include <vector>

#include "eval/report/leaderboard.h"

namespace saccade {

/// How fast and how good a method is.
struct SpeedAndScore {
  std::string method;
  double speed = 0;  ///< times real time, > 0
  double score = 0;  ///< > 0 where lower is better
};

/// The methods of a board that have a score on each of the `sequences` and a speed there, both as
/// geometric means over them; failed runs do not count. Both are by method; one without is left
/// out. Contract: at least one sequence.
[[nodiscard]] std::vector<SpeedAndScore> speeds_and_scores(
    const Leaderboard& board, const Leaderboard& speeds, const std::vector<std::string>& sequences);

/// The Pareto front, from slow to fast: those that no other one beats in the one without being
/// worse in the other.
[[nodiscard]] std::vector<SpeedAndScore> pareto_front(std::vector<SpeedAndScore> points,
                                                      bool higher_is_better);

}  // namespace saccade
