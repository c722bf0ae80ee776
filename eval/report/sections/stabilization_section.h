#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// Events and frames before and after stabilization (thesis figs. 3.2 and 3.3), as HTML; empty for
/// runs that stabilized nothing or whose dataset is gone.
[[nodiscard]] std::string stabilization_section(const RunData& data);

}  // namespace saccade
