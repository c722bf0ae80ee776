#pragma once

#include <string>
#include <vector>

#include "eval/sweep/result/results.h"
#include "eval/table/table.h"

namespace saccade {

/// What the rows of an ablation cost and gain against the sweep's `reference`. Runs of equal dataset
/// and seed are pairs; Wilcoxon's signed-rank test judges them (eval/statistics/signed_rank.h), and
/// Holm's procedure corrects for the number of comparisons. Empty without a reference, or where no
/// row can be compared with it.
///
/// "ablation" has a row for each method: its mean of every metric over the pairs, marked with * where
/// it differs from the reference with a corrected p below 0.05; the best of a column is bold where it
/// differs so from every other row; and the time of a run relative to the reference.
/// "ablation_tests" has a row for each method and metric: number of pairs, both means, the change,
/// the rank-biserial effect (above 0: better than the reference) and the corrected p.
[[nodiscard]] std::vector<Table> ablation_tables(const SweepResults& results);

/// Both as a part of sweep.md; empty without them.
[[nodiscard]] std::string ablation_section(const std::vector<Table>& tables,
                                           const std::string& reference);

}  // namespace saccade
