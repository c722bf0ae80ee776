#include "core/config/convert.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>

#include "core/error.h"

namespace saccade::config {
namespace {

/// Doubles beyond this skip whole numbers, so "1e17" does not say which one is meant.
constexpr double kMaxExactWhole = 9007199254740992.0;

[[noreturn]] void fail(const Node& node, const std::string& name, const std::string& problem) {
  throw error_at(node.location, name, ": ", problem);
}

[[noreturn]] void fail_expected(const Node& node, const std::string& name,
                                const std::string& what) {
  fail(node, name, "expected " + what + ", got " + node.shown());
}

std::string_view without_plus(std::string_view text) {
  const bool signed_twice = text.size() > 1 && (text[1] == '-' || text[1] == '+');
  if (text.starts_with('+') && !signed_twice) text.remove_prefix(1);
  return text;
}

/// All of the text as one number; nullopt for anything else and for what T cannot hold.
template <class T>
std::optional<T> parse_whole_text(std::string_view text) {
  text = without_plus(text);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_plain(const Node& node) { return node.kind == Node::Kind::kScalar && !node.quoted; }

bool is_not_finite(std::string_view text) {
  std::string lower;
  for (const char c : without_plus(text)) lower += static_cast<char>(c | 0x20);
  const std::string_view bare = lower.starts_with('-') ? std::string_view(lower).substr(1) : lower;
  return bare == "nan" || bare == ".nan" || bare == "inf" || bare == ".inf" || bare == "infinity";
}

/// Digits that form a number, though one too large or too small for T.
template <class T>
bool is_beyond(std::string_view text) {
  text = without_plus(text);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc::result_out_of_range && end == text.data() + text.size();
}

template <class T>
void read_whole(const Node& node, const std::string& name, T& value) {
  if (!is_plain(node)) fail_expected(node, name, "a whole number");
  if (const auto exact = parse_whole_text<T>(node.text)) {
    value = *exact;
    return;
  }
  const std::optional<double> number = number_of(node);
  const bool whole = number && std::floor(*number) == *number;
  if (number && !whole) fail_expected(node, name, "a whole number");
  const bool negative = number && *number < 0 && std::numeric_limits<T>::min() == 0;
  if (negative) fail(node, name, node.text + " is below 0");
  if (whole && std::abs(*number) <= kMaxExactWhole &&
      *number <= static_cast<double>(std::numeric_limits<T>::max()) &&
      *number >= static_cast<double>(std::numeric_limits<T>::min())) {
    value = static_cast<T>(*number);
    return;
  }
  if (whole)
    fail(node, name,
         node.text + " does not fit; the largest whole number here is " +
             std::to_string(std::numeric_limits<T>::max()));
  fail_expected(node, name, "a whole number");
}

template <class T>
void read_real(const Node& node, const std::string& name, T& value) {
  if (!is_plain(node)) fail_expected(node, name, "a number");
  const auto number = parse_whole_text<T>(node.text);
  if (is_not_finite(node.text)) fail_expected(node, name, "a finite number");
  if (!number && is_beyond<T>(node.text))
    fail(node, name, node.text + " is too large or too close to 0 for a number");
  if (!number) fail_expected(node, name, "a number");
  value = *number;
}

template <class T>
Node whole_node(T value) {
  return Node::scalar(std::to_string(value), false);
}

template <class T>
Node real_node(T value) {
  std::array<char, 32> buffer{};
  const bool whole = std::floor(value) == value && std::abs(value) < T(1e15);
  const auto [end, error] =
      whole ? std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                            std::chars_format::fixed)
            : std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end);
  // YAML 1.1 readers of other languages take "1e-05" for text.
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos)
    text.insert(exponent, ".0");
  return Node::scalar(text, false);
}

}  // namespace

std::optional<double> number_of(const Node& node) {
  if (!is_plain(node)) return std::nullopt;
  const auto number = parse_whole_text<double>(node.text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

void from_node(const Node& node, const std::string& name, bool& value) {
  const auto is = [&](std::string_view a, std::string_view b, std::string_view c) {
    return is_plain(node) && (node.text == a || node.text == b || node.text == c);
  };
  const bool yes = is("true", "True", "TRUE");
  if (!yes && !is("false", "False", "FALSE")) fail_expected(node, name, "true or false");
  value = yes;
}

void from_node(const Node& node, const std::string& name, int& value) {
  read_whole(node, name, value);
}
void from_node(const Node& node, const std::string& name, std::int64_t& value) {
  read_whole(node, name, value);
}
void from_node(const Node& node, const std::string& name, std::uint64_t& value) {
  read_whole(node, name, value);
}
void from_node(const Node& node, const std::string& name, float& value) {
  read_real(node, name, value);
}
void from_node(const Node& node, const std::string& name, double& value) {
  read_real(node, name, value);
}

void from_node(const Node& node, const std::string& name, std::string& value) {
  if (node.kind != Node::Kind::kScalar) fail_expected(node, name, "text");
  value = node.text;
}

void from_node(const Node& node, const std::string& name, std::filesystem::path& value) {
  if (node.kind != Node::Kind::kScalar) fail_expected(node, name, "a path");
  value = node.text;
  if (value.empty() || value.is_absolute() || !node.location.source) return;
  value = (node.location.source->folder / value).lexically_normal();
}

Node to_node(bool value) { return Node::scalar(value ? "true" : "false", false); }
Node to_node(int value) { return whole_node(value); }
Node to_node(std::int64_t value) { return whole_node(value); }
Node to_node(std::uint64_t value) { return whole_node(value); }
Node to_node(float value) { return real_node(value); }
Node to_node(double value) { return real_node(value); }
Node to_node(const std::string& value) { return Node::scalar(value, true); }

Node to_node(const std::filesystem::path& value) {
  if (value.empty()) return Node::scalar("", true);
  return Node::scalar(std::filesystem::absolute(value).lexically_normal().string(), true);
}

const std::vector<Node>& items_of(const Node& node, const std::string& name) {
  if (node.kind != Node::Kind::kList) fail_expected(node, name, "a list");
  return node.items;
}

const std::vector<Node>& items_of(const Node& node, const std::string& name, std::size_t count) {
  const std::string what = "a list of " + std::to_string(count) + " values";
  if (node.kind != Node::Kind::kList) fail_expected(node, name, what);
  if (node.items.size() != count)
    fail(node, name, "expected " + what + ", got " + std::to_string(node.items.size()));
  return node.items;
}

const std::vector<Entry>& entries_of(const Node& node, const std::string& name) {
  if (node.kind != Node::Kind::kMap) fail_expected(node, name, "a map of keys");
  return node.entries;
}

std::string item_name(const std::string& name, std::size_t index) {
  return name + "[" + std::to_string(index) + "]";
}

}  // namespace saccade::config
