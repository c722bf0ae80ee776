#pragma once

#include <span>
#include <string>

#include "core/io/csv_file.h"
#include "eval/sweep/result/expectations.h"
#include "eval/sweep/result/charts.h"
#include "eval/sweep/result/results.h"

namespace saccade {

/// One row for each job: where it stands in the sweep, whether it is ok or failed, and every metric
/// that any job has. Cells without a value are empty.
[[nodiscard]] CsvTable sweep_csv(const SweepResults& results);

/// The page of a sweep: for each dataset a table with a row for each group, the best value of a
/// column in bold, one table for each module where there are several; then the expected figures,
/// the pictures and the jobs that failed.
[[nodiscard]] std::string sweep_markdown(const SweepResults& results,
                                         std::span<const SweepChart> figures,
                                         std::span<const ExpectationResult> verdicts);

}  // namespace saccade
