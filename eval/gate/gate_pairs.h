#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/gate/comparison.h"

namespace saccade {

/// A run and the one of the baseline that did the same work.
struct GatePair {
  const GateRun* before;
  const GateRun* after;
};

/// Matches by key. A run of the baseline without partner is a regression, unless `partial`; a run
/// that the baseline lacks is a note. Throws InputError where nothing matches.
[[nodiscard]] std::vector<GatePair> match_runs(std::span<const GateRun> baseline,
                                               std::span<const GateRun> runs, bool partial,
                                               GateResult& result);

/// Adds a regression for every metric that some runs of the baseline have as a number and their
/// partners have not: null or absent. Metrics of the speed count only with `speed`.
void add_missing_metrics(std::span<const GatePair> pairs, bool speed, GateResult& result);

/// Adds a regression for every metric whose sign is judged and has changed.
void add_changed_signs(std::span<const GatePair> pairs, GateResult& result);

/// Notes where partners were given other numbers of events, which makes them no pair.
void note_other_data(std::span<const GatePair> pairs, GateResult& result);

}  // namespace saccade
