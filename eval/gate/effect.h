#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/gate/gate_metric.h"
#include "eval/gate/gate_pairs.h"

namespace saccade {

/// The change of one metric over the pairs of one scope.
struct Effect {
  MetricInfo metric;
  std::string scope;
  bool pooled = false;             ///< over several sequences
  std::vector<double> log_ratios;  ///< one per pair (worsening()); above 0 is worse
  double before_sum = 0;
  double after_sum = 0;
  bool times_separated = true;  ///< in every pair the repetitions' times do not overlap

  /// The smallest mean of `log_ratios` that counts as a change.
  [[nodiscard]] double threshold(const GateOptions& options) const;
  [[nodiscard]] bool is_time() const { return metric.key == kGateTime; }
};

/// One effect per judged metric and sequence, and one per metric and module that pools the module's
/// sequences where there are several. Times of pairs from different machines or numbers of threads
/// are left out, with a note. A metric that leaves the domain of the logarithm is a regression
/// ("changed sign"). Throws InputError for a metric of the options that no pair has, or for which
/// neither direction is better.
[[nodiscard]] std::vector<Effect> collect_effects(std::span<const GatePair> pairs,
                                                  const GateOptions& options, GateResult& result);

}  // namespace saccade
