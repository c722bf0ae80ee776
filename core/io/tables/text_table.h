#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/event.h"

namespace saccade {

/// The fields of one line, taken from left to right; separated by spaces, tabs or one comma.
/// Everything that is wrong is an InputError with `file:line`.
class TextRow {
 public:
  /// `readable`: bytes behind `text` that may be looked at, for speed.
  TextRow(const std::string& file, std::size_t line, std::string_view text,
          std::size_t readable = 0)
      : file_(file),
        line_(line),
        rest_(text.data()),
        end_(text.data() + text.size()),
        readable_end_(end_ + readable) {}

  TextRow(std::string&& file, std::size_t line, std::string_view text,
          std::size_t readable = 0) = delete;  // the name outlives the row

  [[nodiscard]] bool at_end() {
    while (rest_ != end_ && is_space(*rest_)) ++rest_;
    return rest_ == end_;
  }
  /// A finite number; `name` is what an error calls it.
  [[nodiscard]] double number(const char* name);
  [[nodiscard]] std::int64_t integer(const char* name) {
    skip_separator();
    if (const ShortNumber number = short_number(); number.digits > 0) {
      rest_ += number.digits;
      return number.value;
    }
    return long_integer(name);
  }
  /// Decimal seconds -> ns, digit by digit and therefore exact; digits below 1 ns round to the
  /// nearest.
  [[nodiscard]] TimeNs seconds(const char* name);
  [[nodiscard]] std::string_view word(const char* name);
  /// Fails unless all fields were taken; `columns`: what the line should hold, e.g. "t x y p".
  void expect_end(const char* columns) {
    if (!at_end()) fail_end(columns);
  }

  [[noreturn]] void fail(const std::string& problem) const;
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  [[nodiscard]] bool ends_field(const char* p) const {
    return p == end_ || is_space(*p) || *p == ',';
  }
  /// Moves to the next field, over spaces and at most one comma.
  void skip_separator() {
    while (rest_ != end_ && is_space(*rest_)) ++rest_;
    if (rest_ != end_ && *rest_ == ',') skip_comma();
    first_ = false;
  }
  void skip_comma();

  struct ShortNumber {
    std::uint32_t digits = 0;  ///< 0: no unsigned number of 1..7 digits, or one too near to the end
    std::uint32_t value = 0;
  };
  /// Without a branch per digit, which the processor cannot predict in coordinates: the eight bytes
  /// are handled at once, the digits moved to the top and their values combined pairwise.
  [[nodiscard]] ShortNumber short_number() const {
    if (readable_end_ - rest_ < 8) return {};
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, rest_, sizeof bytes);
    bytes ^= 0x3030303030303030;  // digits become 0..9, everything else more
    const std::uint64_t others = ((bytes + 0x7676767676767676) | bytes) & 0x8080808080808080;
    const auto digits = static_cast<std::uint32_t>(std::countr_zero(others)) / 8;
    if (digits == 0 || digits == 8 || !ends_field(rest_ + digits)) return {};
    bytes <<= 64 - 8 * digits;
    bytes = bytes * 10 + (bytes >> 8);
    bytes = ((bytes & 0x000000FF000000FF) * 0x000F424000000064 +
             ((bytes >> 16) & 0x000000FF000000FF) * 0x0000271000000001) >>
            32;
    return {digits, static_cast<std::uint32_t>(bytes)};
  }
  [[nodiscard]] std::int64_t long_integer(const char* name);
  [[noreturn]] void fail_end(const char* columns) const;
  [[noreturn]] void fail_field(const char* name, const char* expected) const;

  const std::string& file_;
  std::size_t line_;
  const char* rest_;
  const char* end_;
  const char* readable_end_;
  bool first_ = true;
};

/// The lines of a text in memory that have content: what TextReader leaves out is left out here, too.
class TextLines {
 public:
  /// `name`: what errors call the text; it outlives this. `before`: lines of it that come first;
  /// `readable`: bytes behind `text` that may be looked at.
  TextLines(const std::string& name, std::string_view text, std::size_t before,
            std::size_t readable = 0)
      : name_(name),
        rest_(text),
        line_(before),
        readable_end_(text.data() + text.size() + readable) {}

  /// The next line; false where there is none.
  [[nodiscard]] bool next(std::string_view& line);
  /// Number of the line that next() gave, from 1; after the last one, how many there are.
  [[nodiscard]] std::size_t line_number() const { return line_; }
  [[nodiscard]] TextRow row(std::string_view line) const {
    return {name_, line_, line,
            static_cast<std::size_t>(readable_end_ - (line.data() + line.size()))};
  }

 private:
  const std::string& name_;
  std::string_view rest_;
  std::size_t line_;
  const char* readable_end_;
};

/// Divides a text behind ends of lines into parts of about `bytes`.
[[nodiscard]] std::vector<std::string_view> divide_lines(std::string_view text, std::size_t bytes);

/// Reads a text file line by line in large blocks; lines end in \n or \r\n. Blank lines and lines
/// that start with '#' are skipped.
class TextReader {
 public:
  /// Fills memory and returns how many bytes there were; 0 at the end.
  using Source = std::function<std::size_t(std::span<char>)>;

  explicit TextReader(const std::filesystem::path& file);
  /// `name`: what errors call it.
  TextReader(std::string name, Source source);

  /// The next line with content; false at the end of the file.
  [[nodiscard]] bool next(std::string_view& line);
  /// In place of next(): the whole lines that are in memory, about a megabyte, those without content as
  /// well; empty at the end. Valid until the next call. Their number is for the caller to tell by
  /// count_lines(), since he passes over them anyway.
  [[nodiscard]] std::string_view next_lines();
  void count_lines(std::size_t lines) { line_ += lines; }
  /// Number of the line that next() gave, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_; }
  [[nodiscard]] TextRow row(std::string_view line) const {
    return {name_, line_, line,
            static_cast<std::size_t>(block_.data() + end_ - (line.data() + line.size()))};
  }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] bool refill();
  [[nodiscard]] bool fill();
  [[noreturn]] void fail_long_line() const;

  std::string name_;
  Source source_;
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
void append_decimal_seconds(TimeNs t_ns, std::string& text);
/// The same to where there is room for kMostDecimalSeconds characters; gives the end.
[[nodiscard]] char* write_decimal_seconds(TimeNs t_ns, char* to);
constexpr std::size_t kMostDecimalSeconds = 21;  // "-9223372036.854775808"

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
