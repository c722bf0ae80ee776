#include "core/io/tables/text_table.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/io/files/input_log.h"

namespace saccade {
namespace {

constexpr std::size_t kReadBytes = std::size_t{1} << 20;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::array<std::int64_t, 10> kPowersOfTen{
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

/// Up to nine digits; returns how many there were.
std::ptrdiff_t parse_digits(const char*& p, const char* end, std::int64_t& value) {
  const char* begin = p;
  if (end - p >= 8 && fast_float::is_made_of_eight_digits_fast(p)) {
    value = fast_float::parse_eight_digits_unrolled(p);
    p += 8;
  }
  for (; p != end && is_digit(*p) && p - begin < 9; ++p) value = value * 10 + (*p - '0');
  return p - begin;
}

/// A plain decimal number in units of 1e-9, rounded to the nearest; nullopt when it is no such
/// number or beyond int64. `p` moves behind it.
std::optional<TimeNs> parse_nano(const char*& p, const char* end) {
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int64_t>::max() / 1'000'000'000 - 1;
  const char* begin = p;
  std::int64_t seconds = 0;
  for (; p != end && is_digit(*p); ++p)
    if ((seconds = seconds * 10 + (*p - '0')) > kMaxSeconds) return std::nullopt;
  std::ptrdiff_t count = p - begin;
  std::int64_t nanos = 0;
  if (p != end && *p == '.') {
    const std::ptrdiff_t digits = parse_digits(++p, end, nanos);
    nanos *= kPowersOfTen[static_cast<std::size_t>(9 - digits)];
    if (p != end && is_digit(*p) && *p >= '5') ++nanos;
    while (p != end && is_digit(*p)) ++p;
    count += digits;
  }
  if (count == 0) return std::nullopt;
  const std::int64_t value = seconds * 1'000'000'000 + nanos;
  return negative ? -value : value;
}

/// "d.ddde+XX" -> the same number without exponent; nullopt when the exponent is unreasonable.
std::optional<std::string> without_exponent(std::string_view text) {
  const std::size_t e = text.find_first_of("eE");
  std::string_view shift_text = text.substr(e + 1);
  if (shift_text.starts_with('+')) shift_text.remove_prefix(1);
  int shift = 0;
  const auto [rest, error] =
      std::from_chars(shift_text.data(), shift_text.data() + shift_text.size(), shift);
  if (error != std::errc() || rest != shift_text.data() + shift_text.size() || shift > 30 ||
      shift < -330)
    return std::nullopt;
  std::string digits(text.substr(0, e));
  const std::string sign = digits.starts_with('-') ? "-" : "";
  if (digits.starts_with('-') || digits.starts_with('+')) digits.erase(0, 1);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point != digits.size()) digits.erase(point, 1);
  std::ptrdiff_t position = static_cast<std::ptrdiff_t>(point) + shift;
  if (position < 0) {
    digits.insert(0, static_cast<std::size_t>(-position), '0');
    position = 0;
  }
  if (static_cast<std::size_t>(position) > digits.size())
    digits.append(static_cast<std::size_t>(position) - digits.size(), '0');
  return sign + digits.insert(static_cast<std::size_t>(position), ".");
}

bool has_content(std::string_view line) {
  const std::size_t content = line.find_first_not_of(" \t\r");
  return content != std::string_view::npos && line[content] != '#';
}

}  // namespace

void TextRow::skip_comma() {
  const bool empty_before = first_;
  ++rest_;
  if (empty_before || at_end() || *rest_ == ',') fail("a field is empty");
}

double TextRow::number(const char* name) {
  skip_separator();
  const char* begin = rest_;
  if (begin != end_ && *begin == '+') ++begin;  // from_chars takes no plus
  double value = 0;
  const auto [rest, error] = fast_float::from_chars(begin, end_, value);
  if (error != std::errc() || !ends_field(rest)) fail_field(name, "a number");
  if (!std::isfinite(value)) fail_field(name, "a finite number");
  rest_ = rest;
  return value;
}

std::int64_t TextRow::long_integer(const char* name) {
  std::int64_t value = 0;
  const auto [rest, error] = std::from_chars(rest_, end_, value);
  if (error != std::errc() || !ends_field(rest)) fail_field(name, "a whole number");
  rest_ = rest;
  return value;
}

TimeNs TextRow::seconds(const char* name) {
  skip_separator();
  const char* p = rest_;
  std::optional<TimeNs> value = parse_nano(p, end_);
  if (value && p != end_ && (*p == 'e' || *p == 'E')) {
    while (!ends_field(p)) ++p;
    const std::optional<std::string> plain =
        without_exponent({rest_, static_cast<std::size_t>(p - rest_)});
    const char* digits = plain ? plain->data() : nullptr;
    value = plain ? parse_nano(digits, plain->data() + plain->size()) : std::nullopt;
  }
  if (!value || !ends_field(p)) fail_field(name, "a time in seconds");
  rest_ = p;
  return *value;
}

std::string_view TextRow::word(const char* name) {
  skip_separator();
  const char* begin = rest_;
  while (!ends_field(rest_)) ++rest_;
  if (begin == rest_) fail_field(name, "a word");
  return {begin, static_cast<std::size_t>(rest_ - begin)};
}

void TextRow::fail_end(const char* columns) const {
  fail(std::string("more fields than expected; a line holds `") + columns + "`");
}

void TextRow::fail(const std::string& problem) const {
  throw InputError(file_ + ":" + std::to_string(line_), problem);
}

void TextRow::fail_field(const char* name, const char* expected) const {
  const char* p = rest_;
  while (!ends_field(p) && p - rest_ < 40) ++p;
  const std::string found(rest_, p);
  fail(std::string(name) + ": expected " + expected + ", found " +
       (found.empty() ? "the end of the line" : "'" + found + "'"));
}

TextReader::TextReader(const std::filesystem::path& file) : name_(file.string()) {
  if (std::filesystem::is_directory(file)) throw InputError(name_, "is a folder, not a file");
  const auto stream = std::make_shared<std::ifstream>(file, std::ios::binary);
  if (!*stream)
    throw InputError(name_, std::filesystem::exists(file) ? "cannot be opened" : "no such file");
  InputLog::note(file);
  source_ = [stream](std::span<char> memory) {
    stream->read(memory.data(), static_cast<std::streamsize>(memory.size()));
    return static_cast<std::size_t>(stream->gcount());
  };
  block_.resize(kReadBytes);
}

TextReader::TextReader(std::string name, Source source)
    : name_(std::move(name)), source_(std::move(source)), block_(kReadBytes) {}

void TextReader::fail_long_line() const {
  throw InputError(name_ + ":" + std::to_string(line_ + 1),
                   "a line of more than 1 MiB; this is no table of text");
}

bool TextReader::refill() {
  if (begin_ == 0 && end_ == block_.size()) fail_long_line();
  std::memmove(block_.data(), block_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count = source_(std::span(block_).subspan(end_));
  end_ += count;
  return count > 0;
}

bool TextReader::next(std::string_view& line) {
  for (;;) {
    const char* start = block_.data() + begin_;
    const void* newline = std::memchr(start, '\n', end_ - begin_);
    if (newline == nullptr) {
      if (refill()) continue;
      if (begin_ == end_) return false;
      newline = block_.data() + end_;  // the last line, without \n
      start = block_.data() + begin_;
    }
    const std::size_t length = static_cast<std::size_t>(static_cast<const char*>(newline) - start);
    begin_ = std::min(begin_ + length + 1, end_);
    ++line_;
    line = {start, length};
    if (has_content(line)) return true;
  }
}

/// Fills the block as far as the source goes; false where nothing is left in it.
bool TextReader::fill() {
  while (end_ < block_.size() || begin_ > 0)
    if (!refill()) break;
  return end_ > begin_;
}

std::string_view TextReader::next_lines() {
  if (!fill()) return {};
  const std::string_view text(block_.data() + begin_, end_ - begin_);
  const bool is_last = end_ < block_.size();
  const std::size_t newline = text.rfind('\n');
  if (newline == std::string_view::npos && !is_last) fail_long_line();
  const std::string_view lines = is_last ? text : text.substr(0, newline + 1);
  begin_ += lines.size();
  return lines;
}

bool TextLines::next(std::string_view& line) {
  while (!rest_.empty()) {
    const std::size_t length = std::min(rest_.find('\n'), rest_.size());
    line = rest_.substr(0, length);
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++line_;
    if (has_content(line)) return true;
  }
  return false;
}

std::vector<std::string_view> divide_lines(std::string_view text, std::size_t bytes) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t newline = text.find('\n', std::min(bytes, text.size()) - 1);
    parts.push_back(text.substr(0, newline == std::string_view::npos ? newline : newline + 1));
    text.remove_prefix(parts.back().size());
  }
  return parts;
}

char* write_decimal_seconds(TimeNs t_ns, char* to) {
  const std::uint64_t t =
      t_ns < 0 ? 0 - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  if (t_ns < 0) *to++ = '-';
  // The fraction with a one before it, which keeps its leading zeros and then becomes the point.
  char* const point = std::to_chars(to, to + kMostDecimalSeconds, t / 1'000'000'000).ptr;
  std::array<char, 10> fraction;
  std::to_chars(fraction.begin(), fraction.end(), 1'000'000'000 + t % 1'000'000'000);
  fraction[0] = '.';
  return std::copy(fraction.begin(), fraction.end(), point);
}

void append_decimal_seconds(TimeNs t_ns, std::string& text) {
  std::array<char, kMostDecimalSeconds> digits;
  text.append(digits.data(), write_decimal_seconds(t_ns, digits.data()));
}

std::string decimal_seconds(TimeNs t_ns) {
  std::string text;
  append_decimal_seconds(t_ns, text);
  return text;
}

NumberTable read_number_table(const std::filesystem::path& file, const char* header) {
  std::vector<std::string> names;
  for (std::string_view rest = header; !rest.empty();) {
    const std::size_t length = std::min(rest.find(' '), rest.size());
    names.emplace_back(rest.substr(0, length));
    rest.remove_prefix(std::min(length + 1, rest.size()));
  }
  NumberTable table{file.string(), names.size(), {}, {}};
  for_each_row(file, [&](TextRow& row) {
    for (const std::string& name : names) table.values.push_back(row.number(name.c_str()));
    row.expect_end(header);
    table.lines.push_back(row.line());
    return true;
  });
  return table;
}

}  // namespace saccade
