#pragma once

#include <filesystem>
#include <vector>

#include "eval/sweep/plan/plan.h"
#include "eval/sweep/result/results.h"

namespace saccade {

/// Writes FOLDER/manifest.json and FOLDER/manifest.csv: for each generated dataset its index, name,
/// path (relative to FOLDER), scene, seed and status ("ok", "failed", "waiting"), what was drawn
/// for it, and of those that are there their counts, duration [s], size [bytes], mean rate
/// [events/s] and the SHA-256 of dataset.yaml (which holds those of all other files) and of the
/// resolved configuration.
void write_manifest(const SweepConfig& sweep, const SweepPlan& plan,
                    const std::vector<JobState>& states, const std::filesystem::path& folder);

}  // namespace saccade
