#pragma once

#include <span>

#include "eval/metrics/metrics.h"
#include "eval/run_folder.h"

namespace saccade {

/// How many times an error is that of the refined optimum: of every error among `scores` that
/// `refined` has, too, the key refined_ratio.<key> with the quotient. Null where either is, or the
/// optimum's is 0.
[[nodiscard]] Metrics refined_ratios(const Metrics& scores, const Metrics& refined);

/// The run of `refine`, among some runs over the same dataset, that `run` is compared with: one
/// that was refined from it, else from another run of the same module; nullptr where there is none.
[[nodiscard]] const RunFolder* find_refined(const RunFolder& run,
                                            std::span<const RunFolder* const> runs);

}  // namespace saccade
