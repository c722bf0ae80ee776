#include "eval/table/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <string_view>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/csv_file.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"

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
  // Of the text fonts these would be taken as bitmaps.
  for (const auto& [sign, command] :
       {std::pair<std::string_view, std::string_view>{"×", "$\\times$"},
        {"σ", "$\\sigma$"},
        {"±", "$\\pm$"},
        {"−", "$-$"}})
    for (auto at = result.find(sign); at != std::string::npos; at = result.find(sign, at))
      result.replace(at, sign.size(), command);
  // A hyphen before a number is a minus.
  if (result.size() > 1 && result[0] == '-' && std::isdigit(static_cast<unsigned char>(result[1])))
    result.replace(0, 1, "$-$");
  return result;
}

std::string small_html(const std::string& text) {
  return text.empty() ? "" : "<span class=\"ref\">" + escape_html(text) + "</span>";
}

std::string marked_html(const std::string& html, const Table::Cell& cell) {
  if (cell.mark == Table::Mark::kNone) return cell.best ? "<b>" + html + "</b>" : html;
  return fmt::format("<span class=\"{}\">{}</span>",
                     cell.mark == Table::Mark::kBetter ? "better" : "worse", html);
}

std::string cell_html(const Table::Cell& cell) {
  if (!cell.value) {
    std::string text = marked_html(escape_html(cell.text), cell);
    if (!cell.link.empty())
      text = fmt::format("<a href=\"{}\">{}</a>", escape_html(cell.link), text);
    return fmt::format("<td class=\"name\">{}{}</td>", text, small_html(cell.note));
  }
  const std::string shown = cell.text.empty() ? rounded(cell.value->mean) : escape_html(cell.text);
  return fmt::format("<td data-value=\"{}\">{}{}{}</td>", cell.value->mean,
                     marked_html(shown, cell), small_html(interval_text(*cell.value)),
                     small_html(cell.note));
}

std::string cell_latex(const Table::Cell& cell) {
  if (cell.text == "–") return "--";
  if (!cell.text.empty() || !cell.value)
    return cell.best ? "\\textbf{" + escape_latex(cell.text) + "}" : escape_latex(cell.text);
  const std::string mean = escape_latex(rounded(cell.value->mean));
  const std::string interval = interval_text(*cell.value);
  return (cell.best ? "\\textbf{" + mean + "}" : mean) + (interval.empty() ? "" : " " + interval);
}

/// For every column, whether any of its cells has an interval.
std::vector<bool> with_interval(const Table& table) {
  std::vector<bool> has(table.columns.size(), false);
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i].value && row[i].value->low) has[i] = true;
  return has;
}

/// Characters of UTF-8 text: bytes that continue none.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// The cell where nothing but text can be shown.
std::string plain(const Table::Cell& cell) {
  if (!cell.text.empty() || !cell.value) return cell.text;
  const std::string interval = interval_text(*cell.value);
  return rounded(cell.value->mean) + (interval.empty() ? "" : " " + interval);
}

/// '|' would end a cell.
std::string escape_markdown(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

/// Of a value the mean alone is bold, as in LaTeX.
std::string cell_markdown(const Table::Cell& cell) {
  const std::string text = escape_markdown(plain(cell));
  if (!cell.best) return text;
  const std::size_t end = cell.text.empty() ? text.find(' ') : std::string::npos;
  return "**" + text.substr(0, end) + "**" + (end == std::string::npos ? "" : text.substr(end));
}

/// The cells as plain text, the titles first where there are any.
std::vector<std::vector<std::string>> text_rows(const Table& table) {
  std::vector<std::vector<std::string>> rows(1);
  for (const Table::Column& column : table.columns) rows.front().push_back(column.title);
  if (std::all_of(table.columns.begin(), table.columns.end(),
                  [](const Table::Column& column) { return column.title.empty(); }))
    rows.clear();
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (const Table::Cell& cell : row) rows.back().push_back(plain(cell));
  }
  return rows;
}

}  // namespace

void Table::add_numeric(std::initializer_list<const char*> titles) {
  for (const char* title : titles) columns.push_back({title, true});
}

Table::Cell number_cell(const std::optional<double>& value, const std::string& text,
                        const std::string& note) {
  if (!value) return {text.empty() ? "–" : text, {}, note};
  return {text, PooledValue{.mean = *value}, note};
}

void Table::add(const std::vector<std::string>& cells) {
  SACCADE_CHECK(cells.size() == columns.size());
  std::vector<Cell>& row = rows.emplace_back();
  for (const std::string& text : cells) row.push_back({text});
}

std::string table_text(const Table& table) {
  const auto rows = text_rows(table);
  std::vector<std::size_t> widths(table.columns.size());
  for (const std::vector<std::string>& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - width_of(row[i]), ' ');
      line += i == 0 ? "" : "  ";
      line += table.columns[i].numeric ? space + row[i] : row[i] + space;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string table_markdown(const Table& table) {
  std::string head = "|", rule = "|", text;
  for (const Table::Column& column : table.columns) {
    head += column.title.empty() ? " |" : " " + escape_markdown(column.title) + " |";
    rule += column.numeric ? "---:|" : "---|";
  }
  for (const auto& row : table.rows) {
    text += "|";
    for (const Table::Cell& cell : row) text += " " + cell_markdown(cell) + " |";
    text += "\n";
  }
  return head + "\n" + rule + "\n" + text;
}

std::string table_html(const Table& table) {
  for (const auto& row : table.rows) SACCADE_CHECK(row.size() == table.columns.size());
  std::string html = fmt::format(
      "<h4>{}</h4>\n<div class=\"scroll\"><table class=\"wide sortable\" data-name=\"{}\" "
      "data-csv=\"{}\" data-latex=\"{}\"><thead><tr>",
      escape_html(table.caption), escape_html(table.name), escape_html(table_csv(table)),
      escape_html(table_latex(table)));
  for (const Table::Column& column : table.columns)
    html += fmt::format("<th{}>{}</th>", column.numeric ? "" : " class=\"name\"",
                        escape_html(column.title));
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const Table::Cell& cell : row) html += cell_html(cell);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string table_latex(const Table& table) {
  std::string text =
      fmt::format("% {}\n\\begin{{tabular}}{{l{}}}\n\\toprule\n", table.caption,
                  std::string(table.columns.empty() ? 0 : table.columns.size() - 1, 'r'));
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += (i == 0 ? "" : " & ") + escape_latex(table.columns[i].title);
  text += " \\\\\n\\midrule\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : " & ") + cell_latex(row[i]);
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string table_csv(const Table& table) {
  const std::vector<bool> wide = with_interval(table);
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& title = table.columns[i].title;
    columns.push_back(title);
    if (wide[i])
      for (const char* part : {" low", " high", " n"}) columns.push_back(title + part);
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

void export_tables(std::span<const Table> tables, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string(), error.message());
  for (const Table& table : tables) {
    write_atomically(folder / (table.name + ".tex"), table_latex(table));
    write_atomically(folder / (table.name + ".csv"), table_csv(table));
  }
}

}  // namespace saccade
