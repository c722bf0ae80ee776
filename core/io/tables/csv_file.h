#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace saccade {

/// A comma-separated table with one line of column names, written as a whole by save(). Doubles in
/// their shortest exact form, NaN as an empty cell; text with commas or quotes is quoted.
class CsvTable {
 public:
  using Cell = std::variant<double, long long, std::string>;

  explicit CsvTable(std::vector<std::string> columns);
  /// As many cells as columns (contract).
  void add(const std::vector<Cell>& cells);
  [[nodiscard]] const std::string& text() const { return text_; }
  void save(const std::filesystem::path& file) const;

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace saccade
