#include "eval/sweep/result/stopped_rows.h"

#include <fmt/format.h>

#include "eval/metrics/catalogue.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

std::string name_of(const SweepResults& results, const SweepPoint& point) {
  std::string name = point.configuration;
  if (!point.variant.empty()) name += ", " + point.variant;
  for (std::size_t i = 0; i < point.grid.size(); ++i)
    name += fmt::format(", {} {}", results.plan.axes[i], point.grid[i]);
  return name;
}

}  // namespace

std::string stopped_section(const SweepResults& results) {
  if (results.stopped.empty()) return "";
  Table table{.columns = {{"row"}}};
  table.add_numeric({"rank", "of rows", "after pairs"});
  for (const StoppedRow& row : results.stopped)
    table.add({name_of(results, row.point), std::to_string(row.rank), std::to_string(row.rows),
               std::to_string(row.pairs)});
  return fmt::format(
             "## Stopped early\nBy their mean rank in {} over pairs of dataset and seed. Their "
             "means below are over these pairs alone.\n\n",
             metric_info(results.sweep.halving->metric).label) +
         table_markdown(table) + "\n";
}

}  // namespace saccade
