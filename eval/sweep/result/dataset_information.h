#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "eval/information/information.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/result/results.h"

namespace saccade {

/// By dataset folder.
using DatasetInformation = std::map<std::filesystem::path, Information>;

/// What the generated datasets of a sweep that exist tell at best. FOLDER/information.csv keeps it,
/// with the hash of each dataset.yaml, so that a dataset is looked at once. A dataset without truth
/// has none.
[[nodiscard]] DatasetInformation dataset_information(const SweepPlan& plan,
                                                     const std::filesystem::path& folder);

/// Whether a row's method can succeed on its dataset; nullopt where nobody knows.
[[nodiscard]] std::optional<bool> has_enough(const SweepRow& row);

/// The part of a sweep's page about datasets that tell too little for a module: there a method must
/// refuse, or say that it is lost. Each with its bound and what became of every configuration.
/// Empty where all tell enough.
[[nodiscard]] std::string too_little_section(const SweepResults& results);

}  // namespace saccade
