#pragma once

#include <span>

#include "core/event.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// After a start that was found poses are tracked for so long before it is believed: a start on
/// wrong evidence makes a map on which the next events do not lie.
inline constexpr double kStartTrial_s = 0.1;

/// How the poses fare that follow a start that was found from events alone.
struct StartTrial {
  enum class Outcome {
    kPassed,       ///< also of a start that was given, which has no trial
    kNoMap,        ///< the start shows no edges to track the camera by
    kNoPose,       ///< none follows although half of a trial or more does
    kUnexplained,  ///< they are more likely wrong than right
  };
  Outcome outcome = Outcome::kPassed;
  double probability = 1;  ///< that a pose is right, mean over those of the trial

  [[nodiscard]] bool is_passed() const { return outcome == Outcome::kPassed; }
};

/// The trial of a start that ends at `from_s`. `poses` in order of time, also beyond the trial;
/// `events` of all of the recording, at least one.
[[nodiscard]] StartTrial start_trial(std::span<const TrackedPose> poses,
                                     std::span<const Event> events, double from_s);

}  // namespace saccade
