#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/event.h"

namespace saccade {

/// The fields of one line, taken from left to right; separated by spaces, tabs or one comma.
/// Everything that is wrong is an InputError with `file:line`.
class TextRow {
 public:
  TextRow(const std::string& file, std::size_t line, std::string_view text)
      : file_(file), line_(line), rest_(text.data()), end_(text.data() + text.size()) {}

  [[nodiscard]] bool at_end();
  /// A finite number; `name` is what an error calls it.
  [[nodiscard]] double number(const char* name);
  [[nodiscard]] std::int64_t integer(const char* name);
  /// Decimal seconds -> ns, digit by digit and therefore exact; digits below 1 ns round to the
  /// nearest.
  [[nodiscard]] TimeNs seconds(const char* name);
  [[nodiscard]] std::string_view word(const char* name);
  /// Fails unless all fields were taken; `columns`: what the line should hold, e.g. "t x y p".
  void expect_end(const char* columns);

  [[noreturn]] void fail(const std::string& problem) const;
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  void skip_separator();
  [[noreturn]] void fail_field(const char* name, const char* expected) const;

  const std::string& file_;
  std::size_t line_;
  const char* rest_;
  const char* end_;
  bool first_ = true;
};

/// Reads a text file line by line in large blocks; lines end in \n or \r\n. Blank lines and lines
/// that start with '#' are skipped.
class TextReader {
 public:
  explicit TextReader(const std::filesystem::path& file);

  /// The next line with content; false at the end of the file.
  [[nodiscard]] bool next(std::string_view& line);
  /// Number of the line that next() gave, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_; }
  [[nodiscard]] TextRow row(std::string_view line) const { return {name_, line_, line}; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] bool refill();

  std::string name_;
  std::ifstream stream_;
  std::vector<char> block_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t line_ = 0;
};

/// Calls parse(TextRow&) for every line with content; stops early when it returns false.
template <class Parse>
void for_each_row(const std::filesystem::path& file, const Parse& parse) {
  TextReader reader(file);
  std::string_view line;
  while (reader.next(line)) {
    TextRow row = reader.row(line);
    if (!parse(row)) return;
  }
}

/// ns -> decimal seconds with 9 decimals, exact; what TextRow::seconds() reads back.
[[nodiscard]] std::string decimal_seconds(TimeNs t_ns);

/// A whole table of finite numbers with the same number of columns in every row.
struct NumberTable {
  std::string file;
  std::size_t columns = 0;
  std::vector<double> values;      ///< row-major
  std::vector<std::size_t> lines;  ///< line of each row

  [[nodiscard]] std::size_t rows() const { return lines.size(); }
  [[nodiscard]] double operator()(std::size_t row, std::size_t column) const {
    return values[row * columns + column];
  }
  /// "file:line" of a row.
  [[nodiscard]] std::string place(std::size_t row) const {
    return file + ":" + std::to_string(lines[row]);
  }
};

/// `header`: the names of the columns, e.g. "t tx ty tz qx qy qz qw"; their number is what every
/// line must hold.
[[nodiscard]] NumberTable read_number_table(const std::filesystem::path& file, const char* header);

}  // namespace saccade
