#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/io/dataset/dataset.h"

namespace saccade {

/// What the scores of a run follow from, by name: `run_sha256` (every file of the run folder but
/// those that scoring writes), `dataset_sha256` (dataset.yaml, which holds the hashes of the other
/// files, or else the events; and the ground truth) and `version` (of this program). It stands
/// below `inputs` in metrics.json: scores whose inputs are others are stale.
using ScoreInputs = std::map<std::string, std::string>;

[[nodiscard]] ScoreInputs score_inputs(const std::filesystem::path& run_folder,
                                       const Dataset& dataset);

/// Of RUN/metrics.json; empty where there is none or it states none.
[[nodiscard]] ScoreInputs recorded_inputs(const std::filesystem::path& run_folder);

/// Why the run must be scored again, "the dataset has changed"; empty where metrics.json holds what
/// scoring it would give.
[[nodiscard]] std::string staleness(const std::filesystem::path& run_folder,
                                    const Dataset& dataset);

}  // namespace saccade
