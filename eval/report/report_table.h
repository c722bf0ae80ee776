#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace saccade {

/// A mean, with the interval where there is evidence for one.
struct PooledValue {
  double mean = 0;
  std::optional<double> low;  ///< of the 95 % interval; nullopt: a single value
  std::optional<double> high;
  std::size_t count = 1;  ///< values that were pooled
};

/// One table of numbers for the page and, as LaTeX and CSV, for papers.
struct ReportTable {
  enum class Mark { kNone, kBetter, kWorse };

  struct Cell {
    std::string text;                  ///< plain; empty: the value, rounded, with its interval
    std::optional<PooledValue> value;  ///< sorts the column, and stands unrounded in the CSV
    std::string note = {};             ///< plain, small below it; on the page alone
    bool best = false;                 ///< in bold
    Mark mark = Mark::kNone;           ///< in its colour; on the page alone
  };

  std::string name;     ///< of its files, without extension
  std::string caption;  ///< plain text
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< as many cells as columns (contract)
};

/// A <table> below its caption, which the page's script sorts by its columns and offers as the two
/// files; intervals stand below the means.
[[nodiscard]] std::string table_html(const ReportTable& table);

/// A tabular environment that needs the package booktabs, with the caption as a comment above it.
[[nodiscard]] std::string table_latex(const ReportTable& table);

/// Unrounded; a column with an interval anywhere is followed by "... low", "... high" and "... n".
[[nodiscard]] std::string table_csv(const ReportTable& table);

/// Writes NAME.tex and NAME.csv of every table into the folder, which is made where it is missing.
void export_tables(const std::vector<ReportTable>& tables, const std::filesystem::path& folder);

}  // namespace saccade
