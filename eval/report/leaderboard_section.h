#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "eval/report/report_table.h"
#include "eval/report/run_data.h"

namespace saccade {

/// The tables of methods against sequences (eval/report/leaderboard.h). A method is a module with
/// its configuration's name (eval/configuration_name.h), or an external estimator by its own.
/// `published`: file of scores of other methods (eval/published_rows.h), of which those on the
/// runs' sequences are taken, or empty. Throws InputError as read_published_rows().
[[nodiscard]] std::vector<ReportTable> leaderboard_tables(std::span<const RunData> runs,
                                                          const std::filesystem::path& published);

/// The section with these tables; empty where there are none.
[[nodiscard]] std::string leaderboard_section(std::span<const ReportTable> tables);

}  // namespace saccade
