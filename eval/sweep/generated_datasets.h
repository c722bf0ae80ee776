#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// What clean_generated() took away.
struct CleanSummary {
  std::vector<std::filesystem::path> removed;
  std::uintmax_t bytes = 0;
};

/// Removes the datasets below FOLDER/data that the sweep does not plan any more, as after a smaller
/// count, another name or other shards, with their records below FOLDER/jobs. Only folders of
/// finished datasets whose names end in an index, and what interrupted programs left of such, are
/// touched. Contract: the sweep generates. Throws InputError where `folder` is no sweep, or where
/// another program is filling it.
CleanSummary clean_generated(const SweepConfig& sweep, const std::filesystem::path& folder);

/// What pack_generated() wrote.
struct PackSummary {
  std::size_t archives = 0;
  std::size_t up_to_date = 0;  ///< that were there with the same datasets
  std::size_t datasets = 0;
};

/// Writes the finished datasets as archives for training on other machines: OUTPUT/SPLIT-NN.tar for
/// each split and shard, with SPLIT-NN.json beside it (its datasets, bytes and SHA-256), and the
/// manifest. Equal datasets give equal bytes. An archive whose datasets are those that it was made
/// of is not written again. Contract: the sweep generates. Throws InputError where `folder` holds no
/// manifest, or where tar cannot be run or fails.
PackSummary pack_generated(const SweepConfig& sweep, const std::filesystem::path& folder,
                           const std::filesystem::path& output);

}  // namespace saccade
