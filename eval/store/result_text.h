#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/store/result_diff.h"
#include "eval/store/result_row.h"
#include "eval/store/result_store.h"

namespace saccade {

enum class ResultFormat { kTable, kCsv, kJson };

/// The columns (of result_columns()) and metrics that a list of results shows, in this order.
struct ResultSelection {
  std::vector<ResultColumn> columns;
  std::vector<std::string> metrics;  ///< stored names
};

/// What `names` name, columns first. None named: for a table what tells runs apart and the usual
/// metrics, else everything but the text of the configuration. InputError for an unknown name.
[[nodiscard]] ResultSelection select_columns(const ResultReader& reader,
                                             const std::vector<std::string>& names,
                                             ResultFormat format);

/// One line a run. A table leaves out metrics that no row has, marks them with a dash where a row
/// lacks them, cuts long text, and ends with the number of rows. JSON is a list of objects with the
/// columns and "metrics"; what was not measured is an empty cell, in JSON null.
[[nodiscard]] std::string format_results(std::span<const ResultRow> rows,
                                         const MetricTable& metrics,
                                         std::span<const ResultColumn> columns,
                                         ResultFormat format);

/// format_results() of the runs for which `where` holds.
[[nodiscard]] std::string list_results(ResultReader& reader, std::string_view where,
                                       const std::vector<std::string>& columns,
                                       ResultFormat format);

/// As a table the change of every metric over all pairs (of one pair: its values), as CSV and JSON
/// the values and the change of every metric of every pair.
[[nodiscard]] std::string format_diff(const ResultDiff& diff, ResultFormat format);

}  // namespace saccade
