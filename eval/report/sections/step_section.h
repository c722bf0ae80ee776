#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// Single steps of a reconstruction as HTML, where the run kept them: Poisson's equation on true
/// gradients (thesis fig. 6.1), depth carried to another view (fig. 6.2). Else empty.
[[nodiscard]] std::string step_section(const RunData& data);

}  // namespace saccade
