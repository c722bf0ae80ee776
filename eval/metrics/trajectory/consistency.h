#pragma once

#include <optional>
#include <span>

#include "core/io/covariance_file.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// Normalised estimation error squared (Bar-Shalom et al., 2001, 5.4.2): the mean of e^T P^-1 e
/// over the covariances within the scored interval, e the twist of truth^-1 estimate at their
/// times. 6 for errors that are as large as P says, more where it promises too much. nullopt
/// without truth, estimate or a covariance that is positive definite.
[[nodiscard]] std::optional<double> nees(std::span<const StampedCovariance> covariances,
                                         const TrajectoryScoreInput& input);

constexpr double kNeesOfTruth = 6;  ///< of errors as large as the covariances say

/// The factor between a NEES and the 6 of errors as large as the covariances say, above or below:
/// max(NEES / 6, 6 / NEES), 1 at best. `nees` > 0.
[[nodiscard]] double nees_factor(double nees);

}  // namespace saccade
