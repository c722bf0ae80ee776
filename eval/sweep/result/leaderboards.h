#pragma once

#include <string>

#include "eval/sweep/result/results.h"

namespace saccade {

/// The part of a sweep's page that ranks its configurations within their classes
/// (eval/report/leaderboard.h); each generated dataset is a sequence of its own. Empty where the
/// sweep has one configuration or one dataset, or varies keys of a configuration.
[[nodiscard]] std::string sweep_leaderboards(const SweepResults& results);

}  // namespace saccade
