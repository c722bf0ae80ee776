#include "estimator/tracking/intensity/threshold_estimator.h"

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

/// The weight of the expected thresholds, in events.
constexpr double kExpectedEvents = 20;
constexpr double kLeast = 0.02, kMost = 5;  ///< [log units]

}  // namespace

ThresholdEstimator::ThresholdEstimator(std::size_t pixels)
    : pixels_(pixels),
      on_{kExpectedEvents * kExpected.on * kExpected.on, kExpectedEvents},
      off_{kExpectedEvents * kExpected.off * kExpected.off, kExpectedEvents} {}

void ThresholdEstimator::add_event(std::size_t pixel, int polarity) {
  Pixel& one = pixels_[pixel];
  (polarity > 0 ? one.since.on : one.since.off) += 1;
  one.level.sum.on += one.since.on;
  one.level.sum.off += one.since.off;
  one.level.events += 1;
}

void ThresholdEstimator::measure(std::size_t pixel, float log_intensity, float weight) {
  Pixel& one = pixels_[pixel];
  if (!(one.level.events > 0)) return;
  const Counts at{one.level.sum.on / one.level.events, one.level.sum.off / one.level.events};
  const bool has_one_polarity = (at.on > 0) != (at.off > 0);
  if (std::isfinite(one.log_intensity) && has_one_polarity) {
    const auto change = static_cast<double>(log_intensity - one.log_intensity);
    const auto events = static_cast<double>(at.on + at.off);
    const auto w = static_cast<double>(weight);
    Sums& sums = at.on > 0 ? on_ : off_;
    sums.changes += w * change * change;
    sums.events += w * events * events;
  }
  one.log_intensity = log_intensity;
  one.since.on -= at.on;
  one.since.off -= at.off;
  one.level = {};
}

double ThresholdEstimator::Sums::threshold() const {
  return std::clamp(std::sqrt(changes / events), kLeast, kMost);
}

EventContrast ThresholdEstimator::contrast() const { return {on_.threshold(), off_.threshold()}; }

}  // namespace saccade
