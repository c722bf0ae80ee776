#pragma once

#include "estimator/tracking/tracker.h"

namespace saccade {

/// Log odds that a pose is not lost, from its evidence, its standard deviations and the tracker's
/// own opinion: a logistic regression (docs/tracking.md, "How lost poses are known").
[[nodiscard]] double log_odds_of(const TrackedPose& pose);

/// 1 / (1 + exp(-log_odds)).
[[nodiscard]] double probability_of(double log_odds);

}  // namespace saccade
