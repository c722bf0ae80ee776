#include "eval/metrics/trajectory/consistency.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace saccade {

std::optional<double> nees(std::span<const StampedCovariance> covariances,
                           const TrajectoryScoreInput& input) {
  const std::optional<RunRecord::Window> interval = scored_interval(input.truth, input.window);
  if (!interval || input.estimate.empty()) return std::nullopt;
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

double nees_factor(double nees) { return std::max(nees / kNeesOfTruth, kNeesOfTruth / nees); }

}  // namespace saccade
