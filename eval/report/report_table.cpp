#include "eval/report/report_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/csv_file.h"
#include "eval/number_text.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

std::string interval_text(const PooledValue& value) {
  if (!value.low) return "";
  return fmt::format("[{}, {}]", rounded(value.low), rounded(value.high));
}

std::string escape_latex(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\textbackslash{}";
    else if (c == '[')  // at the head of a row it would be an option of the line break before
      result += "{[}";
    else if (c == '~' || c == '^')
      result += fmt::format("\\{}{{}}", c);
    else if (std::string_view("#$%&_{}").find(c) != std::string_view::npos)
      result += {'\\', c};
    else
      result += c;
  }
  return result;
}

std::string small_html(const std::string& text) {
  return text.empty() ? "" : "<span class=\"ref\">" + escape_html(text) + "</span>";
}

std::string marked_html(const std::string& html, const ReportTable::Cell& cell) {
  if (cell.mark == ReportTable::Mark::kNone) return cell.best ? "<b>" + html + "</b>" : html;
  return fmt::format("<span class=\"{}\">{}</span>",
                     cell.mark == ReportTable::Mark::kBetter ? "better" : "worse", html);
}

std::string cell_html(const ReportTable::Cell& cell) {
  if (!cell.value)
    return fmt::format("<td class=\"name\">{}{}</td>", marked_html(escape_html(cell.text), cell),
                       small_html(cell.note));
  const std::string shown = cell.text.empty() ? rounded(cell.value->mean) : escape_html(cell.text);
  return fmt::format("<td data-value=\"{}\">{}{}{}</td>", cell.value->mean,
                     marked_html(shown, cell), small_html(interval_text(*cell.value)),
                     small_html(cell.note));
}

std::string cell_latex(const ReportTable::Cell& cell) {
  if (cell.text == "–") return "--";
  if (!cell.text.empty() || !cell.value) return escape_latex(cell.text);
  const std::string mean = rounded(cell.value->mean);
  const std::string interval = interval_text(*cell.value);
  return (cell.best ? "\\textbf{" + mean + "}" : mean) + (interval.empty() ? "" : " " + interval);
}

/// For every column, whether any of its cells has an interval.
std::vector<bool> with_interval(const ReportTable& table) {
  std::vector<bool> has(table.columns.size(), false);
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i].value && row[i].value->low) has[i] = true;
  return has;
}

/// Whether no row has a number in the column.
bool is_text(const ReportTable& table, std::size_t column) {
  return std::none_of(table.rows.begin(), table.rows.end(),
                      [&](const auto& row) { return row[column].value.has_value(); });
}

}  // namespace

std::string table_html(const ReportTable& table) {
  for (const auto& row : table.rows) SACCADE_CHECK(row.size() == table.columns.size());
  std::string html = fmt::format(
      "<h4>{}</h4>\n<div class=\"scroll\"><table class=\"wide sortable\" data-name=\"{}\" "
      "data-csv=\"{}\" data-latex=\"{}\"><thead><tr>",
      escape_html(table.caption), escape_html(table.name), escape_html(table_csv(table)),
      escape_html(table_latex(table)));
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    html += fmt::format("<th{}>{}</th>", is_text(table, i) ? " class=\"name\"" : "",
                        escape_html(table.columns[i]));
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const ReportTable::Cell& cell : row) html += cell_html(cell);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string table_latex(const ReportTable& table) {
  std::string text =
      fmt::format("% {}\n\\begin{{tabular}}{{l{}}}\n\\toprule\n", table.caption,
                  std::string(table.columns.empty() ? 0 : table.columns.size() - 1, 'r'));
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += (i == 0 ? "" : " & ") + escape_latex(table.columns[i]);
  text += " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : " & ") + cell_latex(row[i]);
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string table_csv(const ReportTable& table) {
  const std::vector<bool> wide = with_interval(table);
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    columns.push_back(table.columns[i]);
    if (wide[i])
      for (const char* part : {" low", " high", " n"}) columns.push_back(table.columns[i] + part);
  }
  CsvTable csv(columns);
  const auto number = [](const std::optional<double>& value) {
    return value.value_or(std::numeric_limits<double>::quiet_NaN());
  };
  for (const auto& row : table.rows) {
    std::vector<CsvTable::Cell> cells;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::optional<PooledValue>& value = row[i].value;
      if (value)
        cells.emplace_back(value->mean);
      else
        cells.emplace_back(row[i].text == "–" ? "" : row[i].text);
      if (!wide[i]) continue;
      cells.emplace_back(number(value ? value->low : std::nullopt));
      cells.emplace_back(number(value ? value->high : std::nullopt));
      cells.emplace_back(static_cast<long long>(value ? value->count : 0));
    }
    csv.add(cells);
  }
  return csv.text();
}

void export_tables(const std::vector<ReportTable>& tables, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string(), error.message());
  for (const ReportTable& table : tables) {
    write_atomically(folder / (table.name + ".tex"), table_latex(table));
    write_atomically(folder / (table.name + ".csv"), table_csv(table));
  }
}

}  // namespace saccade
