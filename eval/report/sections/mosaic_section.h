#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The mosaic of a run as HTML: scores, mosaic, truth and error, the mosaic growing with the
/// events. Empty where the run has none or its dataset is gone.
[[nodiscard]] std::string mosaic_section(const RunData& data);

}  // namespace saccade
