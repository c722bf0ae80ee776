#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The images of a run as HTML: scores of every view; truth, reconstruction, error and deviation of
/// the gradient of one view, what is unobserved in colour; the image growing with the events
/// (thesis figs. 8.14 and 8.15). Empty where the run has none or its dataset is gone.
[[nodiscard]] std::string image_section(const RunData& data);

}  // namespace saccade
