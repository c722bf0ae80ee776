#include "core/io/tables/csv_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/check.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string shown(const CsvTable::Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
  if (const auto* whole = std::get_if<long long>(&cell)) return std::to_string(*whole);
  const double value = std::get<double>(cell);
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

}  // namespace

CsvTable::CsvTable(std::vector<std::string> columns) : columns_(columns.size()) {
  add({columns.begin(), columns.end()});
}

void CsvTable::add(const std::vector<Cell>& cells) {
  SACCADE_CHECK(cells.size() == columns_);
  for (std::size_t i = 0; i < cells.size(); ++i) text_ += (i > 0 ? "," : "") + shown(cells[i]);
  text_ += '\n';
}

void CsvTable::save(const std::filesystem::path& file) const { write_atomically(file, text_); }

}  // namespace saccade
