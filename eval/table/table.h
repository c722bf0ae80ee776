#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace saccade {

/// A mean, with the interval where there is evidence for one.
struct PooledValue {
  double mean = 0;
  std::optional<double> low = {};  ///< of the 95 % interval; nullopt: a single value
  std::optional<double> high = {};
  std::size_t count = 1;  ///< values that were pooled
};

/// A table before it is known where it will be shown: in a terminal, as Markdown, on an HTML page,
/// in a LaTeX document or as CSV. All five show the same cells.
struct Table {
  enum class Mark { kNone, kBetter, kWorse };

  struct Column {
    std::string title;
    bool numeric = false;  ///< aligned to the right

    [[nodiscard]] bool operator==(const Column&) const = default;
  };

  struct Cell {
    std::string text;  ///< plain; empty: the value with three digits and its interval
    std::optional<PooledValue> value = {};  ///< sorts the column, and stands unrounded in the CSV
    std::string note = {};                  ///< plain, small below it; on the page alone
    bool best = false;                      ///< in bold, but in a terminal
    Mark mark = Mark::kNone;                ///< in its colour; on the page alone
    std::string link = {};                  ///< address behind the text; on the page alone
  };

  std::string name = {};     ///< of its files, without extension; only export_tables() needs one
  std::string caption = {};  ///< plain text
  std::vector<Column> columns = {};
  std::vector<std::vector<Cell>> rows = {};  ///< as many cells as columns (contract)

  /// Appends numeric columns.
  void add_numeric(std::initializer_list<const char*> titles);
  /// Appends a row of plain text.
  void add(const std::vector<std::string>& cells);
};

/// A number, shown as `text` or with three digits where that is empty; a dash without the number.
[[nodiscard]] Table::Cell number_cell(const std::optional<double>& value,
                                      const std::string& text = {}, const std::string& note = {});

/// For a terminal: columns as wide as their widest cell with two spaces between them, without the
/// caption, and without the row of titles where all of them are empty.
[[nodiscard]] std::string table_text(const Table& table);

/// A pipe table without the caption; '|' in cells is escaped, the best cells are **bold**.
[[nodiscard]] std::string table_markdown(const Table& table);

/// A <table> below its caption, which the page's script sorts by its columns and offers as CSV and
/// LaTeX; intervals and notes stand below the values.
[[nodiscard]] std::string table_html(const Table& table);

/// A tabular environment that needs the package booktabs, with the caption as a comment above it.
[[nodiscard]] std::string table_latex(const Table& table);

/// Unrounded; a column with an interval anywhere is followed by "... low", "... high" and "... n".
[[nodiscard]] std::string table_csv(const Table& table);

/// Writes NAME.tex and NAME.csv of every table into the folder, which is made where it is missing.
void export_tables(std::span<const Table> tables, const std::filesystem::path& folder);

}  // namespace saccade
