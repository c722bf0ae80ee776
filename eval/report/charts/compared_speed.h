#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/leaderboard.h"

namespace saccade {

/// Error against speed on a sequence, or with an empty name over all of a board's
/// (eval/report/charts/pareto.h), with the Pareto front: a chart for each board but the speed's on which
/// two methods or more have both. A board of a single sequence is drawn as the mean alone.
[[nodiscard]] std::vector<PageChart> compared_speed(std::span<const Leaderboard> boards,
                                                    const std::string& sequence,
                                                    const MethodStyles& styles);

}  // namespace saccade
