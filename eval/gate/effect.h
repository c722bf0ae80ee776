#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/gate/gate_metric.h"
#include "eval/gate/gate_pairs.h"

namespace saccade {

/// What the pairs of a scope say about a metric.
struct Effect {
  MetricInfo metric;
  std::string scope;
  bool pooled = false;             ///< over several sequences
  std::vector<double> worsenings;  ///< of the pairs, above 0 is worse
  double before_sum = 0;
  double after_sum = 0;
  bool apart = true;  ///< in every pair the repetitions' times do not overlap

  /// The smallest mean of `worsenings` that counts.
  [[nodiscard]] double threshold(const GateOptions& options) const;
  [[nodiscard]] bool is_time() const { return metric.key == kGateTime; }
};

/// Of every judged metric: its sequences, and for each module with several sequences all of them
/// together. The time of pairs that ran on other machines or threads is left out, and a note says
/// so; a metric that falls out of the logarithm's domain is a regression ("other sign"). Throws
/// InputError for a metric of the options that no pair has or that has no better side.
[[nodiscard]] std::vector<Effect> collect_effects(std::span<const GatePair> pairs,
                                                  const GateOptions& options, GateResult& result);

}  // namespace saccade
