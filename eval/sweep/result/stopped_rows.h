#pragma once

#include <string>

#include "eval/sweep/result/results.h"

namespace saccade {

/// The part of a sweep's page about the rows that halving stopped early; empty where there are none.
[[nodiscard]] std::string stopped_section(const SweepResults& results);

}  // namespace saccade
