#include "estimator/tracking/check/pose_probability.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// The regression: log odds = constant + sum of weight * feature. Fitted by
/// tests/calibration/fit_probability.py, which says how, to runs over the worlds of
/// tests/calibration/loss_worlds.yaml.
constexpr double kConstant = 4.95;
constexpr double kExplainedWeight = 2.53;
constexpr double kSeenWeight = 19.6;
constexpr double kSigmaWeight = -10.8;
constexpr double kInMapWeight = 1.94;
constexpr double kTrackerLostWeight = -3.16;

/// Beyond these a feature says no more: what is explained well is not explained twice, and a pose of
/// sigmas below the limits may be consistently wrong: methods state them too small, or too large.
constexpr double kLeastExplained = 0.03, kMostExplained = 0.4;
constexpr double kMostSeen = 0.1;
constexpr double kLeastLogSigma = 0, kMostLogSigma = 1;

/// How far a fraction lies above what a wrong pose would give, relative to what is left: 0 for no
/// better, 1 for all (Cohen's kappa).
double above_chance(double fraction, double by_chance) {
  constexpr double kLeast = 1e-3;
  return (fraction - by_chance) / std::max(1 - by_chance, kLeast);
}

/// The larger of both standard deviations in units of the limits of a loss.
double log_sigma(const TrackedPose& pose) {
  const double depth_m = pose.evidence.depth_m;
  double sigma = pose.rotation_sigma_rad / kLossAngle_rad;
  if (depth_m > 0) sigma = std::max(sigma, pose.position_sigma_m / (kLossDepthRatio * depth_m));
  if (!std::isfinite(sigma)) return kMostLogSigma;
  return sigma > 0 ? std::log(sigma) : kLeastLogSigma;  // 0: the method states none
}

}  // namespace

double log_odds_of(const TrackedPose& pose) {
  const PoseEvidence& evidence = pose.evidence;
  const double explained = std::log(std::clamp(above_chance(evidence.explained, evidence.chance),
                                               kLeastExplained, kMostExplained));
  const double seen = std::clamp(
      above_chance(evidence.edges_confirmed, evidence.confirmed_if_wrong), -kMostSeen, kMostSeen);
  const double sigma = std::clamp(log_sigma(pose), kLeastLogSigma, kMostLogSigma);
  return kConstant + kExplainedWeight * explained + kSeenWeight * seen + kSigmaWeight * sigma +
         kInMapWeight * evidence.in_map + (evidence.tracker_lost ? kTrackerLostWeight : 0);
}

double probability_of(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

}  // namespace saccade
