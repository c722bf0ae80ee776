#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "eval/report/leaderboard.h"
#include "eval/report/run_data.h"

namespace saccade {

/// The runs' methods against sequences. `published`: file of scores of other methods
/// (eval/report/reference/published_rows.h), of which those on the runs' sequences are taken, or empty. Throws
/// InputError as read_published_rows().
[[nodiscard]] std::vector<Leaderboard> leaderboards_of(std::span<const RunData> runs,
                                                       const std::filesystem::path& published);

/// The section with their tables; empty where there are none.
[[nodiscard]] std::string leaderboard_section(std::span<const Table> tables);

}  // namespace saccade
