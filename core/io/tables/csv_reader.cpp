#include "core/io/tables/csv_reader.h"

#include <fast_float/fast_float.h>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

CsvColumns::CsvColumns(const std::filesystem::path& file) : file_(file.string()) {
  TextReader reader(file);
  std::string_view line;
  if (!reader.next(line)) throw InputError(file_, "must start with a line of column names");
  names_ = split(line);
  while (reader.next(line)) {
    std::vector<std::string> cells = split(line);
    if (cells.size() != names_.size())
      throw InputError(file_ + ":" + std::to_string(reader.line_number()),
                       "holds " + std::to_string(cells.size()) + " cells, the header " +
                           std::to_string(names_.size()));
    for (std::string& cell : cells) cells_.push_back(std::move(cell));
    lines_.push_back(reader.line_number());
  }
}

std::optional<std::size_t> CsvColumns::find(std::string_view name) const {
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (names_[i] == name) return i;
  return std::nullopt;
}

std::size_t CsvColumns::require(std::string_view name) const {
  const std::optional<std::size_t> column = find(name);
  if (!column)
    throw InputError(file_, "has no column '" + std::string(name) + "', only " + joined(names_));
  return *column;
}

double CsvColumns::number(std::size_t row, std::size_t column) const {
  const std::string& cell = text(row, column);
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto result = fast_float::from_chars(cell.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end)
    throw InputError(file_ + ":" + std::to_string(lines_[row]),
                     names_[column] + " must be a number, is '" + cell + "'");
  return value;
}

}  // namespace saccade
