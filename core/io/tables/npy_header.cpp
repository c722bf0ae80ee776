#include "core/io/tables/npy_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace saccade {
namespace {

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 16U;
constexpr std::size_t kMostItemBytes = std::size_t{1} << 20U;  ///< of a row

/// The subset of Python's literals that headers are made of.
class Literals {
 public:
  explicit Literals(std::string_view text) : text_(text) {}

  [[nodiscard]] char peek() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n'))
      text_.remove_prefix(1);
    return text_.empty() ? '\0' : text_.front();
  }
  bool take(char c) {
    if (peek() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c))
      throw NpyError{fmt::format("the header is malformed: '{}' is missing before '{}'", c,
                                 text_.substr(0, 20))};
  }
  std::string string() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') expect('\'');
    text_.remove_prefix(1);
    const std::size_t end = text_.find(quote);
    if (end == std::string_view::npos) throw NpyError{"the header is malformed: a quote is open"};
    std::string value(text_.substr(0, end));
    text_.remove_prefix(end + 1);
    return value;
  }
  std::uint64_t whole() {
    static_cast<void>(peek());
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc())
      throw NpyError{fmt::format("the header is malformed: '{}' is no size", text_.substr(0, 20))};
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    if (text_.starts_with('L')) text_.remove_prefix(1);  // of Python 2
    return value;
  }
  bool truth() {
    for (const std::string_view word : {std::string_view("True"), std::string_view("False")}) {
      if (peek() != word.front() || !text_.starts_with(word)) continue;
      text_.remove_prefix(word.size());
      return word == "True";
    }
    throw NpyError{"the header is malformed: neither True nor False"};
  }
  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> sizes;
    expect('(');
    while (!take(')')) {
      sizes.push_back(whole());
      if (peek() != ')') expect(',');
    }
    return sizes;
  }

 private:
  std::string_view text_;
};

/// "<i8", "|u1".
NpyType parse_type(const std::string& text) {
  std::size_t bytes = 0;
  const auto [end, error] = std::from_chars(text.data() + std::min<std::size_t>(2, text.size()),
                                            text.data() + text.size(), bytes);
  if (text.size() < 3 || error != std::errc() || end != text.data() + text.size() ||
      bytes > kMostHeaderBytes)
    throw NpyError{fmt::format("'{}' is no type of numbers", text)};
  if (text[0] == '>' && bytes > 1)
    throw NpyError{
        fmt::format("numbers of the type '{}' are big-endian; store them little-endian, "
                    "in NumPy by array.astype(array.dtype.newbyteorder('<'))",
                    text)};
  const char kind = text[1];
  const bool is_number =
      (kind == 'i' || kind == 'u') && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
  if (!is_number && !(kind == 'f' && (bytes == 4 || bytes == 8)) && !(kind == 'b' && bytes == 1) &&
      kind != 'V' && kind != 'U')
    throw NpyError{fmt::format("numbers of the type '{}' cannot be read", text)};
  return {kind, kind == 'U' ? 4 * bytes : bytes};
}

/// A type, or a list of the fields of a structure.
void read_types(Literals& text, NpyHeader& header) {
  if (text.peek() != '[') {
    header.fields = {{"", parse_type(text.string()), 0}};
    header.item_bytes = header.fields.front().type.bytes;
    return;
  }
  text.expect('[');
  while (!text.take(']')) {
    text.expect('(');
    const std::string name = text.string();
    text.expect(',');
    const NpyType type = parse_type(text.string());
    text.expect(')');
    // Text and raw bytes are no numbers: they are passed over.
    if (type.kind != 'V' && type.kind != 'U')
      header.fields.push_back({name, type, header.item_bytes});
    header.item_bytes += type.bytes;
    if (header.item_bytes > kMostItemBytes)
      throw NpyError{fmt::format("the header claims {} bytes for a row", header.item_bytes)};
    if (text.peek() != ']') text.expect(',');
  }
}

}  // namespace

std::size_t npy_header_bytes(std::string_view prefix) {
  if (prefix.size() < kNpyPrefixBytes || !prefix.starts_with(kNpyMagic))
    throw NpyError{"is no array in NumPy's format"};
  const auto byte = [&](std::size_t at) {
    return std::size_t{static_cast<unsigned char>(prefix[at])};
  };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3)
    throw NpyError{fmt::format("version {} of NumPy's format is not known; 1 to 3 are", version)};
  const std::size_t size =
      version == 1 ? 10 + byte(8) + (byte(9) << 8U)
                   : 12 + byte(8) + (byte(9) << 8U) + (byte(10) << 16U) + (byte(11) << 24U);
  if (size < kNpyPrefixBytes) throw NpyError{"the header claims to be empty"};
  if (size > kMostHeaderBytes) throw NpyError{fmt::format("the header claims {} bytes", size)};
  return size;
}

NpyHeader parse_npy_header(std::string_view header) {
  Literals text(header.substr(header[6] == 1 ? 10 : 12));
  NpyHeader result;
  bool has_types = false;
  bool has_shape = false;
  text.expect('{');
  while (!text.take('}')) {
    const std::string key = text.string();
    text.expect(':');
    if (key == "descr") {
      read_types(text, result);
      has_types = true;
    } else if (key == "fortran_order") {
      result.is_fortran = text.truth();
    } else if (key == "shape") {
      result.shape = text.tuple();
      has_shape = true;
    } else {
      throw NpyError{fmt::format("the header has the unknown key '{}'", key)};
    }
    if (text.peek() != '}') text.expect(',');
  }
  if (!has_types || !has_shape || result.item_bytes == 0)
    throw NpyError{"the header states no type or no shape"};
  return result;
}

std::string npy_header_text(std::string_view type, const std::vector<std::uint64_t>& shape) {
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                 type, fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  constexpr std::size_t kPrefix = 10;
  constexpr std::size_t kAlignment = 64;
  while ((kPrefix + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  std::string header(kNpyMagic);
  header +=
      {'\x01', '\x00', static_cast<char>(text.size() % 256), static_cast<char>(text.size() / 256)};
  return header + text;
}

}  // namespace saccade
