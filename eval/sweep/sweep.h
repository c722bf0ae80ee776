#pragma once

#include <filesystem>
#include <string>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// The outcome of a sweep, in numbers of jobs.
struct SweepSummary {
  std::size_t done = 0;     ///< by this call
  std::size_t skipped = 0;  ///< done before, with the same inputs
  std::size_t failed = 0;
  std::size_t stopped = 0;  ///< of rows that halving gave up
  std::size_t missed = 0;   ///< expected metrics
  bool interrupted = false;
};

/// Makes all datasets, runs and scores that do not exist yet, then writes the tables over all of
/// them (write_sweep_results). `folder` holds sweep.yaml, data/NAME, runs/NAME,
/// jobs/NAME/{job.yaml, log.txt}. Simulations run first and one at a time, because each uses all
/// cores. A job that fails is reported on stderr with its command and the end of its log; the
/// others continue. A sweep with `generate` makes its datasets, each with `threads` threads, and
/// their manifest (write_manifest), which is also written after an interrupt. `jobs`: at a time; 0:
/// one per core; with `timing` always one. Throws InputError when `folder` holds anything but a
/// sweep, or another program is writing to it.
SweepSummary run_sweep(const SweepConfig& sweep, const std::filesystem::path& folder,
                       Launcher& launcher, int jobs = 0);

/// Estimates the cost of the datasets that a sweep with `generate` has still to make: their number,
/// the first command line, and the events, disk space and time from a calibration run on this
/// machine (run_calibration). Writes nothing.
[[nodiscard]] std::string estimate_generation(const SweepConfig& sweep,
                                              const std::filesystem::path& folder, int jobs = 0);

/// What run_sweep() would do: of each job the name, whether and why it would run, and its command
/// lines. Writes nothing.
[[nodiscard]] std::string describe_sweep(const SweepConfig& sweep,
                                         const std::filesystem::path& folder);

}  // namespace saccade
