#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/gate/comparison.h"
#include "eval/report/run_data.h"

namespace saccade {

/// Two runs of one key of the gate.
struct RunPair {
  /// "walls, track accurate"; without the configuration where those are compared.
  std::string scope;
  const RunData* a = nullptr;
  const RunData* b = nullptr;
};

/// Two sets of runs that did the same work: A before, B after.
struct RunSetComparison {
  std::string a, b;  ///< what tells them apart: the version, the method, or "before" and "after"
  std::vector<RunPair> pairs;  ///< in the order of B
  GateResult result;           ///< by the gate's rules; runs of B without a partner are notes
};

/// Pairs the runs, at least one on either side, by dataset, module, configuration and seed; where
/// no two have the same configuration, by the rest: then configurations are compared. Throws
/// InputError where nothing can be paired or two runs of a side did the same work.
[[nodiscard]] RunSetComparison compare_run_sets(std::span<const RunData> before,
                                                std::span<const RunData> after);

}  // namespace saccade
