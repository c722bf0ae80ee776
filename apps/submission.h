#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "eval/sweep/plan/sweep_config.h"

namespace saccade {

/// Adds the methods in folders with an adapter.yaml (docs/submissions.md) to the configurations of
/// a sweep. Throws InputError where a folder holds none, one lacks its licence or its class, or the
/// sweep varies keys that an adapter does not have.
void add_submissions(SweepConfig& sweep, std::span<const std::filesystem::path> folders);

/// Runs the commands that prepare them, in their folders, where what they print becomes prepare.log.
/// Throws InputError where one fails, and where another program is filling the sweep's `folder`,
/// which may be running them.
void prepare_submissions(std::span<const std::filesystem::path> submissions,
                         const std::filesystem::path& folder);

/// A line for each: licence, link, and its time beside the one that its authors state.
[[nodiscard]] std::string describe_submissions(std::span<const std::filesystem::path> submissions,
                                               const SweepConfig& sweep,
                                               const std::filesystem::path& folder);

}  // namespace saccade
