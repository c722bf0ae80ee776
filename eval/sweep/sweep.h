#pragma once

#include <filesystem>
#include <string>

#include "eval/sweep/launch/launcher.h"
#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// How a sweep is run, beside what its file says.
struct SweepOptions {
  int jobs = 0;  ///< runs at a time; 0: one per core. With `timing` always one
};

/// What became of a sweep.
struct SweepSummary {
  std::size_t done = 0;     ///< now
  std::size_t skipped = 0;  ///< done before, of the same inputs
  std::size_t failed = 0;
  std::size_t missed = 0;  ///< expected figures
  bool interrupted = false;
};

/// Where the sweep generates: makes its datasets, each with `threads` threads, and a manifest
/// (write_manifest), which is written when it was interrupted, too. Else:
/// Makes all datasets, runs and scores that are not there yet, then writes the table over all of
/// them (write_sweep_results). `folder` holds sweep.yaml, data/NAME, runs/NAME,
/// jobs/NAME/{job.yaml, log.txt}. Simulations go first and one at a time, because each of them uses
/// all cores. A job that fails is reported on stderr with its command and the end of its log, and
/// the others go on. InputError when `folder` holds something that is no sweep, or another program
/// is at work in it.
SweepSummary run_sweep(const SweepConfig& sweep, const std::filesystem::path& folder,
                       Launcher& launcher, const SweepOptions& options = {});

/// What a sweep that generates would still make: how many datasets, the first of their command
/// lines, and what they take, from a pilot on this machine (run_calibration). Writes nothing but that.
[[nodiscard]] std::string estimate_generation(const SweepConfig& sweep,
                                              const std::filesystem::path& folder,
                                              const SweepOptions& options = {});

/// What run_sweep() would do: for each job its name, whether and why it would run, and its command
/// lines. Writes nothing.
[[nodiscard]] std::string describe_sweep(const SweepConfig& sweep,
                                         const std::filesystem::path& folder);

}  // namespace saccade
