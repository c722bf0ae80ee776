#pragma once

#include <optional>
#include <vector>

#include "core/io/run/run_record.h"
#include "core/trajectory.h"

namespace saccade {

/// Older than this, a pose no longer covers the time [s].
constexpr double kMaxPoseAgeS = 0.02;
/// Spacing of the instants at which errors are taken [s].
constexpr double kScoreStepS = 0.001;

/// The time that is scored: `window` (what the estimator was given; the whole truth without one)
/// cut to the ground truth. nullopt where there is no truth or nothing of it in the window.
[[nodiscard]] std::optional<RunRecord::Window> scored_interval(
    const Trajectory& truth, const std::optional<RunRecord::Window>& window);

/// What an estimate claims at `t_s`: interpolated between poses at most 20 ms apart; in a longer
/// gap the pose before it is held; before the first pose the first and after the last pose the
/// last. `estimate` is not empty.
[[nodiscard]] Rigid3 held_pose(const Trajectory& estimate, double t_s);

/// Fraction of the interval with a pose not older than 20 ms, 0..1:
///   | interval and union of [t_i, t_i + 20 ms] | / | interval |.
/// What is missing before the first and after the last pose counts against it. An interval of
/// length zero has coverage 1 if a pose covers it, else 0.
[[nodiscard]] double coverage(const Trajectory& estimate, const RunRecord::Window& interval);

/// Estimate (as held) and truth at start, start + 1 ms, ... of the scored interval, so that frame
/// density does not weigh.
struct ScoredSamples {
  std::vector<double> t_s;
  std::vector<Rigid3> estimated;  ///< world_from_camera
  std::vector<Rigid3> truth;      ///< world_from_camera
};

/// Empty where `estimate` is empty.
[[nodiscard]] ScoredSamples take_samples(const Trajectory& estimate, const Trajectory& truth,
                                         const RunRecord::Window& interval);

}  // namespace saccade
