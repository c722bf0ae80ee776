#pragma once

#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/sides.h"
#include "eval/table/table.h"

namespace saccade {

/// Every comparison of the gate: the metric on A and on B, the difference [%] with its interval,
/// and whether B is better, worse or equal.
[[nodiscard]] Table against_table(const Sides& sides);

/// The section with this table, and for each sequence and method the errors of both sides over
/// time, of the first seed. Appends the charts to those of the page.
[[nodiscard]] std::string against_section(const Sides& sides, std::vector<PageChart>& page);

}  // namespace saccade
