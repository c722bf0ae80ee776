#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "eval/metrics/metrics.h"

namespace saccade {

/// Whether a run came to anything, and to what.
struct RunOutcome {
  std::optional<double> success;  ///< its metric; nullopt: the run cannot be scored
  bool has_failed = false;        ///< it was refused, crashed, or wrote nothing of use
};

/// A share of runs with Wilson's 95 % interval.
struct SuccessShare {
  double value = 0;
  double low = 0;
  double high = 0;
  std::size_t count = 0;  ///< runs of which it is known
};

/// The share that succeeded. A run that failed did not; of one that cannot be scored nothing is
/// known. nullopt where no run was scored.
[[nodiscard]] std::optional<SuccessShare> success_share(std::span<const RunOutcome> runs);

/// Whether tracking was lost, or no pose was found.
[[nodiscard]] bool was_lost(const Metrics& metrics);

/// What went wrong in a run with a trajectory: `problem` where there is one, "lost after 0.42 s", or
/// "ATE of 1.8 % of the depth" where the error alone keeps it from success. Empty where it succeeded
/// or nothing is known.
[[nodiscard]] std::string failure_text(const Metrics& metrics, const std::string& problem);

}  // namespace saccade
