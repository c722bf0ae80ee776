#pragma once

#include <filesystem>
#include <string>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// How far a sweep is, whichever program fills its folder and wherever its jobs run, from the files
/// in it alone: numbers of jobs that are done, running, failed or waiting, the rate of the last ten
/// minutes with the time left, and the first failures with their reasons. A job is done where its
/// record exists; whether the record is still current is the matter of describe_sweep(). Writes
/// nothing. Throws InputError where `folder` is no sweep.
[[nodiscard]] std::string sweep_status(const SweepConfig& sweep,
                                       const std::filesystem::path& folder);

/// The jobs for another workflow manager, as JSON:
///   {"folder": DIR, "threads": N, "jobs": [{"name", "needs": [names], "output", "scores", "log",
///    "commands": [[word, ...], ...]}]}
/// in an order in which every job stands behind those that it needs. A command is to be called as
/// `saccade WORD...`. Writes nothing.
[[nodiscard]] std::string sweep_jobs_json(const SweepConfig& sweep,
                                          const std::filesystem::path& folder);

}  // namespace saccade
