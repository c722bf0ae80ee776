#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace saccade {

/// A comma-separated table with one line of column names, as CsvTable writes it. Quoted cells are
/// not supported. Throws InputError with `file:line` where a row has another number of cells.
class CsvColumns {
 public:
  explicit CsvColumns(const std::filesystem::path& file);

  [[nodiscard]] std::size_t rows() const { return lines_.size(); }
  /// The column of that name; nullopt when there is none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// The same; InputError naming the file and its columns.
  [[nodiscard]] std::size_t require(std::string_view name) const;

  [[nodiscard]] const std::string& text(std::size_t row, std::size_t column) const {
    return cells_[row * names_.size() + column];
  }
  /// NaN where the cell is empty; InputError with `file:line` where it is no number.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;

 private:
  std::string file_;
  std::vector<std::string> names_;
  std::vector<std::string> cells_;  ///< row-major
  std::vector<std::size_t> lines_;
};

}  // namespace saccade
