#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/leaderboard.h"
#include "eval/report/run_data.h"

namespace saccade {

/// Methods against each other, in charts: error against speed, and for every sequence with several
/// methods the errors over time and their distributions. Empty where there is nothing to compare.
/// `boards`: of the runs. Appends the charts that the HTML refers to to those of the page.
[[nodiscard]] std::string compared_section(std::span<const RunData> runs,
                                           std::span<const Leaderboard> boards,
                                           std::vector<PageChart>& page);

}  // namespace saccade
