#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/event.h"
#include "core/io/tables/leading_digits.h"

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
    if (const LeadingDigits number = short_number(); number.count > 0) {
      rest_ += number.count;
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

  /// An unsigned number of 1 to 7 digits, the whole field; no digits where it is none or too near to
  /// the end.
  [[nodiscard]] LeadingDigits short_number() const {
    if (readable_end_ - rest_ < 8) return {};
    const LeadingDigits digits = leading_digits(rest_);
    return digits.count > 0 && digits.count < 8 && ends_field(rest_ + digits.count)
               ? digits
               : LeadingDigits{};
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
  /// What comes after that line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// In place of next(): takes the next line, which with its end has so many bytes of rest().
  void skip_line(std::size_t length) {
    rest_.remove_prefix(length);
    ++line_;
  }
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
