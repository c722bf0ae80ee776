#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// What became of the jobs of other folders.
struct MergeSummary {
  std::size_t taken = 0;
  std::size_t there = 0;  ///< were done in the folder itself
  /// Jobs that are done elsewhere but not as they would be here, with the reason.
  std::vector<std::pair<std::string, std::string>> refused;
};

/// Takes what other folders of the same sweep have done, as on other clusters, into `folder`: runs
/// and datasets are copied, datasets of the cache linked. A job is taken where it was made by the
/// same command from equal inputs (files may lie elsewhere) by the same program; what is done in
/// `folder` itself stays. A sweep there then makes what no folder has. Throws InputError where `folder` holds
/// something else or one of `others` is no sweep.
MergeSummary merge_sweeps(const SweepConfig& sweep, const std::filesystem::path& folder,
                          std::span<const std::filesystem::path> others);

}  // namespace saccade
