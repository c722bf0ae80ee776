#pragma once

#include <span>
#include <vector>

#include "eval/gate/comparison.h"

namespace saccade {

/// A run and the run of the baseline with the same key.
struct GatePair {
  const GateRun* before;
  const GateRun* after;
};

/// Matches runs by their keys. A run of the baseline without a partner is a regression unless
/// `partial`; a run that is not in the baseline is a note. Throws InputError where nothing matches.
[[nodiscard]] std::vector<GatePair> match_runs(std::span<const GateRun> baseline,
                                               std::span<const GateRun> runs, bool partial,
                                               GateResult& result);

/// Adds a regression for every metric that is a number in a run of the baseline and null or absent
/// in its partner. Speed metrics count only with `speed`.
void add_missing_metrics(std::span<const GatePair> pairs, bool speed, GateResult& result);

/// Adds a regression for every metric of is_judged_by_sign() whose sign has changed.
void add_changed_signs(std::span<const GatePair> pairs, GateResult& result);

/// Adds a note for each pair whose runs processed different numbers of events: not the same data.
void note_other_data(std::span<const GatePair> pairs, GateResult& result);

}  // namespace saccade
