#include "eval/report/sections/page_sections.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "eval/report/charts/timed_error.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

using Verdict = GateRow::Verdict;
using Mark = Table::Mark;

Mark mark_of(const GateRow& row) {
  if (row.verdict == Verdict::kSame) return Mark::kNone;
  return row.verdict == Verdict::kImproved ? Mark::kBetter : Mark::kWorse;
}

Table::Cell change_cell(const GateRow& row) {
  if (!row.change) return {"–", {}};
  PooledValue percent{100 * *row.change, {}, {}, row.pairs};
  // Resamples without spread put an end at infinity.
  if (row.low && row.high && std::isfinite(*row.high)) {
    percent.low = 100 * *row.low;
    percent.high = 100 * *row.high;
  }
  return {"", percent};
}

Table::Cell verdict_cell(const GateRow& row) {
  const Mark mark = mark_of(row);
  const char* text = mark == Mark::kNone ? "equal" : mark == Mark::kBetter ? "better" : "worse";
  return {text, {}, row.note, false, mark};
}

/// The charts of a pair's errors.
std::vector<PageChart> pair_charts(const RunSetComparison& comparison, const RunPair& pair) {
  const std::vector<std::pair<ChartCurve, const RunData*>> both{
      {{"A: " + comparison.a, "s0"}, pair.a}, {{"B: " + comparison.b, "s1"}, pair.b}};
  const std::array runs{pair.a, pair.b};
  std::vector<PageChart> charts;
  for (const TimedError& error : timed_errors(runs)) {
    PageChart chart = chart_over_time(error, pair.scope, both);
    // The same sequence and error may stand in the comparison of methods.
    chart.id = "against/" + chart.id;
    if (chart.curves.size() == both.size()) charts.push_back(std::move(chart));
  }
  return charts;
}

std::string notes_html(const GateResult& result) {
  std::string html;
  for (const std::string& note : result.notes)
    html += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  return html;
}

}  // namespace

Table against_table(const RunSetComparison& comparison) {
  Table table{
      "against",
      fmt::format("B ({}) against A ({}), means over the pairs", comparison.b, comparison.a),
      {{"scope"},
       {"metric"},
       {"pairs", true},
       {"A", true},
       {"B", true},
       {"difference [%]", true},
       {"B is"}}};
  for (const GateRow& row : comparison.result.rows)
    table.rows.push_back({{row.scope, {}},
                          {row.metric, {}},
                          number_cell(static_cast<double>(row.pairs), std::to_string(row.pairs)),
                          number_cell(row.before),
                          number_cell(row.after),
                          change_cell(row),
                          verdict_cell(row)});
  return table;
}

std::string against_section(const RunSetComparison& comparison, std::vector<PageChart>& page) {
  std::string html = fmt::format(
      "<section id=\"against\"><h2>A against B</h2>\n<p>A: {}. B: {}. Runs of the same sequence, "
      "module, configuration and seed are pairs; where A and B are configurations, all but that. "
      "The difference is the mean over the pairs of the ratio B / A, less 1, in logarithms; its "
      "99 % interval holds for all comparisons of the table together. Better or worse is what the "
      "gate would say: below six pairs only of a gross change.</p>\n",
      escape_html(comparison.a), escape_html(comparison.b));
  html += table_html(against_table(comparison)) + notes_html(comparison.result);
  std::set<std::string> shown;
  std::string grid;
  for (const RunPair& pair : comparison.pairs) {
    if (!shown.insert(pair.scope).second) continue;
    const std::string charts = chart_grid(pair_charts(comparison, pair), page);
    if (!charts.empty()) grid += fmt::format("<h3>{}</h3>\n", escape_html(pair.scope)) + charts;
  }
  return html + grid + "</section>\n";
}

}  // namespace saccade
