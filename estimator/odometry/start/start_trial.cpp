#include "estimator/odometry/start/start_trial.h"

#include <cstddef>

namespace saccade {

StartTrial start_trial(std::span<const TrackedPose> poses, std::span<const Event> events,
                       double from_s) {
  const double until_s = from_s + kStartTrial_s;
  double sum = 0;
  std::size_t count = 0;
  for (const TrackedPose& pose : poses) {
    const double t_s = seconds_from_ns(pose.t_ns);
    if (t_s <= from_s || t_s > until_s) continue;
    sum += pose.probability;
    ++count;
  }
  StartTrial trial;
  if (count == 0) {
    const bool goes_on = (from_s + until_s) / 2 <= seconds_from_ns(events.back().t_ns);
    if (goes_on) trial.outcome = StartTrial::Outcome::kNoPose;
    return trial;
  }
  trial.probability = sum / static_cast<double>(count);
  constexpr double kLeast = 0.5;  // more likely wrong than right
  if (trial.probability < kLeast) trial.outcome = StartTrial::Outcome::kUnexplained;
  return trial;
}

}  // namespace saccade
