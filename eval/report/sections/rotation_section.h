#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The angular velocity of a run that found one, axis by axis over time, beside the truth where
/// there is one; empty where it found none.
[[nodiscard]] std::string rotation_section(const RunData& data);

}  // namespace saccade
