#include "eval/gate/gate_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/number_text.h"
#include "eval/report/html.h"

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

/// The width of a text on a terminal: its number of UTF-8 characters.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<std::string> cells_of(const GateRow& row) {
  return {name_of(row.verdict), row.metric,       row.scope,
          values_text(row),     change_text(row), evidence_text(row)};
}

std::string aligned(const std::vector<std::vector<std::string>>& table) {
  std::vector<std::size_t> widths(table.empty() ? 0 : table.front().size());
  for (const auto& cells : table)
    for (std::size_t i = 0; i < cells.size(); ++i)
      widths[i] = std::max(widths[i], width_of(cells[i]));
  std::string text;
  for (const auto& cells : table) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i)
      line += cells[i] + std::string(widths[i] - width_of(cells[i]) + 2, ' ');
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

/// '|' would end a cell.
std::string markdown_cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

}  // namespace

std::string gate_text(const GateResult& result, bool all) {
  std::vector<std::vector<std::string>> table;
  for (const GateRow& row : result.rows)
    if (all || row.verdict != Verdict::kSame) table.push_back(cells_of(row));
  std::string text = aligned(table);
  for (const std::string& note : result.notes) text += "note: " + note + "\n";
  return text + count_text(result) + "\n";
}

std::string gate_markdown(const GateResult& result) {
  std::string text = fmt::format("**saccade gate: {}.** {}\n",
                                 result.tripped() ? "tripped" : "passed", count_text(result));
  if (result.count(Verdict::kSame) < result.rows.size())
    text +=
        "\n| | metric | scope | before -> after | change | evidence |\n|---|---|---|---|---|---|\n";
  for (const GateRow& row : result.rows) {
    if (row.verdict == Verdict::kSame) continue;
    text += "|";
    for (const std::string& cell : cells_of(row)) text += " " + markdown_cell(cell) + " |";
    text += "\n";
  }
  for (const std::string& note : result.notes) text += "\nNote: " + note + "\n";
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
