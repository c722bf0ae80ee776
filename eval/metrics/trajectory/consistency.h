#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <span>

#include "core/io/covariance_file.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"

namespace saccade {

/// Normalised estimation error squared (Bar-Shalom et al., 2001, 5.4.2): the mean of e^T P^-1 e
/// over the covariances within the scored interval, e the twist of truth^-1 estimate at their
/// times. 6 for errors that are as large as P says, more where it promises too much. nullopt
/// without truth, estimate or a covariance that is positive definite, and where the world of the
/// estimate is free, about which its covariances say nothing.
[[nodiscard]] inline std::optional<double> nees(std::span<const StampedCovariance> covariances,
                                                const TrajectoryScoreInput& input) {
  const std::optional<RunRecord::Window> interval = scored_interval(input.truth, input.window);
  if (!interval || input.estimate.empty() || input.freedom != Alignment::kNone) return std::nullopt;
  double sum = 0, count = 0;
  for (const StampedCovariance& entry : covariances) {
    if (entry.t_s < interval->start_s || entry.t_s > interval->end_s) continue;
    const Eigen::LLT<Matrix6> factor(entry.covariance);
    if (factor.info() != Eigen::Success) continue;
    const Twist error =
        (input.truth.at_clamped(entry.t_s).inverse() * input.estimate.at_clamped(entry.t_s)).log();
    sum += error.dot(factor.solve(error));
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

constexpr double kNeesOfTruth = 6;  ///< of errors as large as the covariances say

/// The factor between a NEES and the 6 of errors as large as the covariances say, above or below:
/// max(NEES / 6, 6 / NEES), 1 at best. `nees` > 0.
[[nodiscard]] inline double nees_factor(double nees) {
  return std::max(nees / kNeesOfTruth, kNeesOfTruth / nees);
}

}  // namespace saccade
