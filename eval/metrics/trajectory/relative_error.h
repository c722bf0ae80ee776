#pragma once

#include <numbers>
#include <vector>

#include "eval/metrics/metrics.h"
#include "eval/metrics/trajectory/scored_samples.h"

namespace saccade {

/// Errors of rotation are stated in degrees.
inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// Relative pose errors over sub-trajectories: with A_ij = A_i^-1 A_j the motion from sample i to
/// j,
///   E_ij = truth_ij^-1 estimated_ij,  translation error |t(E_ij)| [m], rotation error angle(E_ij).
/// Pairs (i, j):
///   rpe.length_{10,20,30,40,50}_percent   j is the first sample whose true path length from i
///     reaches that fraction of the whole true path: `trans_percent` (mean of error / path from i
///     to j), `trans_rmse_m`, `rot_rmse_deg`, `rot_deg_per_m` (mean of error / path from i to j);
///   rpe.per_second   j is one second after i: `trans_rmse_m`, `rot_rmse_deg`;
/// and `pairs`, their number. Every sample i that has a j counts. No such pair, or a camera that
/// does not move (path below 1 um): null.
/// Sets the keys below "trajectory.rpe".
void set_relative_errors(Metrics& metrics, const ScoredSamples& samples);

/// The errors of the pairs (i, j) above over one fraction of the path.
struct SegmentErrors {
  std::vector<double> trans_percent;  ///< 100 |t(E_ij)| / path from i to j
  std::vector<double> rot_deg_per_m;
};
/// `percent` of the true path, in (0, 100]. Empty where there is no such pair or no path.
[[nodiscard]] SegmentErrors segment_errors(const ScoredSamples& samples, double percent);

/// True path length from the first sample to each sample [m], samples.t_s.size() entries.
[[nodiscard]] std::vector<double> path_lengths(const ScoredSamples& samples);

/// trajectory.drift_percent: |t(E_0n)| between the first and the last sample over the true path
/// length, in percent: the end error where the starts coincide. nullopt for a path below 1 um.
[[nodiscard]] std::optional<double> drift_percent(const ScoredSamples& samples);

}  // namespace saccade
