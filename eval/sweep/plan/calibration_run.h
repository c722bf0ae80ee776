#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// A sum over many datasets, as the mean over some of them tells it.
struct Estimate {
  double value = 0;
  double spread = 0;  ///< half of the 95 % interval of the mean, times the number of datasets
};

/// What all datasets together will take, extrapolated from pieces of a few of them.
struct CalibrationRun {
  std::size_t datasets = 0;  ///< that were tried
  double window_s = 0;       ///< of each; a second piece was twice as long
  double cost_s = 0;         ///< of the pilot itself
  double duration_s = 0;     ///< of all datasets together
  Estimate events;
  Estimate bytes;
  Estimate core_s;  ///< one at a time
};

/// The mean of a sample times `count`, with the interval that Student's t gives the mean. A sample
/// of all there are (`count` values) has no spread.
[[nodiscard]] Estimate scaled_estimate(const std::vector<double>& sample, std::size_t count);

/// Has the program read the configurations of up to eight of the jobs, evenly spread, without
/// simulating anything. InputError with what it printed where it refuses one: an unknown key, a
/// range that leaves what the simulation takes.
void check_configurations(const std::vector<const SweepJob*>& jobs, Launcher& launcher);

/// Simulates the begin of up to eight of the jobs, evenly spread, twice: over `window_s` and twice
/// as long; a straight line through both gives the whole. Runs through `launcher`, one at a time,
/// in a temporary folder that is removed. InputError with what the program printed where one fails
/// (a range that leaves what the simulation takes).
[[nodiscard]] CalibrationRun run_calibration(const std::vector<const SweepJob*>& jobs, Launcher& launcher);

/// "3.2 G events, ...": what a person needs to decide.
[[nodiscard]] std::string calibration_text(const CalibrationRun& pilot, std::size_t count, int parallel_jobs);

}  // namespace saccade
