#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// A sum over many datasets, extrapolated from the mean over some of them.
struct Estimate {
  double value = 0;
  double spread = 0;  ///< half of the 95 % confidence interval, times the number of datasets
};

/// The cost of all datasets together, extrapolated from short simulations of a few of them.
struct CalibrationRun {
  std::size_t datasets = 0;  ///< number of simulated datasets
  double window_s = 0;       ///< simulated time of long ones; a second simulation lasts twice that
  double cost_s = 0;         ///< wall time of the calibration run itself
  double duration_s = 0;     ///< simulated time of all datasets together
  Estimate events;
  Estimate bytes;
  Estimate core_s;  ///< wall times of all datasets, with as many at a time as in the generation
};

/// The mean of a sample times `count`, with its interval by Student's t. A sample of all datasets
/// (`count` values) has no spread.
[[nodiscard]] Estimate scaled_estimate(const std::vector<double>& sample, std::size_t count);

/// Lets the program read the configurations of up to eight of the jobs, evenly spaced, without
/// simulating. Throws InputError with the program's output where it rejects one: an unknown key, or
/// a range beyond what the simulation accepts.
void check_configurations(const std::vector<const SweepJob*>& jobs, Launcher& launcher);

/// Simulates some of the jobs, evenly spaced, eight after eight, until the time of all is known to a
/// tenth or the calibration has taken a tenth of it, 20 s at least and five minutes at most: short
/// ones as a whole, of others the beginning twice, over `window_s` and over twice that time, from
/// which the whole is extrapolated linearly. Runs through `launcher` within `limits` in temporary
/// folders; a line on stderr says how far it is. Throws InputError with the program's output where a
/// simulation fails.
[[nodiscard]] CalibrationRun run_calibration(const std::vector<const SweepJob*>& jobs,
                                             const LaunchLimits& limits, Launcher& launcher);

/// The estimated events, disk space and time of `count` datasets, for a person to read.
[[nodiscard]] std::string calibration_text(const CalibrationRun& calibration, std::size_t count,
                                           int parallel_jobs);

}  // namespace saccade
