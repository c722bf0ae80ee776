#include "eval/gate/gate_report.h"

#include <fmt/format.h>

#include <cmath>

#include "eval/report/html.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Verdict = GateRow::Verdict;

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRegressed:
      return "regressed";
    case Verdict::kImproved:
      return "improved";
    case Verdict::kSame:
      break;
  }
  return "unchanged";
}

/// "+5.2 %"; a change that rounds to 0 has no sign.
std::string percent(double change) {
  return std::abs(change) < 5e-4 ? "0.0 %" : fmt::format("{:+.1f} %", 100 * change);
}

std::string change_text(const GateRow& row) {
  if (!row.change) return row.note;
  std::string text = percent(*row.change);
  if (row.low && row.high) text += fmt::format(" [{}, {}]", percent(*row.low), percent(*row.high));
  return text;
}

/// The p-value and the number of pairs.
std::string evidence_text(const GateRow& row) {
  if (row.p) return fmt::format("p {:.2g}, {} pairs", *row.p, row.pairs);
  if (row.pairs == 0) return "";
  const std::string pairs = fmt::format("{} {}", row.pairs, row.pairs == 1 ? "pair" : "pairs");
  return row.change && !row.note.empty() ? pairs + "; " + row.note : pairs;
}

std::string values_text(const GateRow& row) {
  if (!row.before && !row.after) return "";
  return significant(row.before, 4) + " -> " + significant(row.after, 4);
}

std::string count_text(const GateResult& result) {
  return fmt::format("{} regressed, {} improved, {} unchanged", result.count(Verdict::kRegressed),
                     result.count(Verdict::kImproved), result.count(Verdict::kSame));
}

std::vector<std::string> cells_of(const GateRow& row) {
  return {name_of(row.verdict), row.metric,       row.scope,
          values_text(row),     change_text(row), evidence_text(row)};
}

/// Escaped for a workflow command; `:` and `,` end a property, but not the message.
std::string workflow_text(const std::string& text, bool is_property) {
  std::string escaped;
  for (const char c : text) {
    const bool special =
        c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    escaped += special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return escaped;
}

Table table_of(const GateResult& result, bool all) {
  Table table{
      .columns = {{""}, {"metric"}, {"scope"}, {"before -> after"}, {"change"}, {"evidence"}}};
  for (const GateRow& row : result.rows)
    if (all || row.verdict != Verdict::kSame) table.add(cells_of(row));
  return table;
}

}  // namespace

std::string gate_text(const GateResult& result, bool all) {
  Table table = table_of(result, all);
  for (Table::Column& column : table.columns) column.title.clear();
  std::string text = table_text(table);
  for (const std::string& note : result.notes) text += "note: " + note + "\n";
  return text + count_text(result) + "\n";
}

std::string gate_markdown(const GateResult& result) {
  std::string text = fmt::format("**saccade gate: {}.** {}\n",
                                 result.tripped() ? "tripped" : "passed", count_text(result));
  if (result.count(Verdict::kSame) < result.rows.size())
    text += "\n" + table_markdown(table_of(result, false));
  for (const std::string& note : result.notes) text += "\nNote: " + note + "\n";
  return text;
}

std::string gate_annotations(const GateResult& result, const std::string& file) {
  const std::string at = file.empty() ? "" : "file=" + workflow_text(file, true) + ",";
  std::string text;
  for (const GateRow& row : result.rows) {
    if (row.verdict != Verdict::kRegressed) continue;
    std::string message = row.scope;
    for (const std::string& part : {values_text(row), change_text(row), evidence_text(row)})
      if (!part.empty()) message += ", " + part;
    text +=
        fmt::format("::error {}title={}::{}\n", at, workflow_text("regressed: " + row.metric, true),
                    workflow_text(message, false));
  }
  for (const std::string& note : result.notes)
    text += fmt::format("::warning {}title=saccade gate::{}\n", at, workflow_text(note, false));
  return text;
}

std::string gate_junit(const GateResult& result) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format("<testsuite name=\"saccade gate\" tests=\"{}\" failures=\"{}\">\n",
                      result.rows.size(), result.count(Verdict::kRegressed));
  for (const GateRow& row : result.rows) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escape_html(row.scope),
                        escape_html(row.metric));
    const std::string message =
        escape_html(values_text(row) + ", " + change_text(row) + ", " + evidence_text(row));
    if (row.verdict == Verdict::kRegressed)
      text += fmt::format(">\n    <failure message=\"{}\"/>\n  </testcase>\n", message);
    else
      text += "/>\n";
  }
  return text + "</testsuite>\n";
}

}  // namespace saccade
