#pragma once

#include <span>
#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The tables at the head of the page, each with its heading, as HTML. The thesis's number stands
/// below ours; factors are thesis / ours for errors and ours / thesis for speed, so above 1 is
/// better.

/// Thesis table 8.2; empty where no run has a trajectory score.
[[nodiscard]] std::string accuracy_table(std::span<const RunData> runs);
/// Scores of depth; empty where no run has any.
[[nodiscard]] std::string depth_table(std::span<const RunData> runs);
/// Thesis table 8.1, one row per dataset.
[[nodiscard]] std::string dataset_table(std::span<const RunData> runs);
/// Thesis table 8.3; empty where no run was timed.
[[nodiscard]] std::string speed_table(std::span<const RunData> runs);

}  // namespace saccade
