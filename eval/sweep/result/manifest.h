#pragma once

#include <filesystem>

#include "eval/sweep/plan/plan.h"

namespace saccade {

/// Writes FOLDER/manifest.json and FOLDER/manifest.csv. They list of each generated dataset its
/// index, name, path (relative to FOLDER), scene, split, seed, status ("ok", "failed", "waiting") and
/// sampled parameters, and of those that exist their counts, duration [s], size [bytes], mean rate
/// [events/s] and the SHA-256 of dataset.yaml (which holds those of all other files) and of the
/// resolved configuration. Above them stand the program's version and commit, the SHA-256 of
/// sweep.yaml and of the scenes' configurations, and the classes. FOLDER/train.txt, val.txt and
/// test.txt hold the paths of the datasets of a split that exist. write_dataset_card() follows.
void write_manifest(const SweepConfig& sweep, const SweepPlan& plan,
                    const std::filesystem::path& folder);

}  // namespace saccade
