#pragma once

#include <string>

#include "eval/sweep/result/results.h"

namespace saccade {

/// "ok", "lost", "refused", "failed", or how an external program ended, such as "timed out".
[[nodiscard]] std::string status_of(const SweepRow& row);

/// "lost after 0.42 s", or what a run that came to nothing says of it; empty where all is well.
[[nodiscard]] std::string reason_of(const SweepRow& row);

/// The part at the head of a sweep's page: how many runs of each configuration came to nothing or
/// were lost, and why. Empty where none did.
[[nodiscard]] std::string failures_section(const SweepResults& results);

}  // namespace saccade
