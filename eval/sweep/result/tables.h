#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/io/tables/csv_file.h"
#include "eval/sweep/result/results.h"
#include "eval/table/table.h"

namespace saccade {

/// One row per job: its coordinates in the sweep, its status with the reason of a failure or loss,
/// and every metric that any job has.
/// Cells without a value are empty.
[[nodiscard]] CsvTable sweep_csv(const SweepResults& results);

/// The page of a sweep: the runs that failed or were lost; for each dataset (and module, where there
/// are several) a table with a row per group, the best value of a column in bold; then all datasets
/// pooled, the leaderboard, the comparisons with the reference (`ablation`, of ablation_tables()),
/// the expected metrics and the charts.
[[nodiscard]] std::string sweep_markdown(const SweepResults& results,
                                         std::span<const std::string> charts,
                                         std::span<const ExpectationResult> expectations,
                                         const std::vector<Table>& ablation = {});

}  // namespace saccade
