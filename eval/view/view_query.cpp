#include "eval/view/view_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace saccade {
namespace {

bool is_name(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
}

/// The text before `separator`, which goes with it.
std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

}  // namespace

ViewQuery ViewQuery::parse(std::string_view target) {
  ViewQuery query;
  query.name_ = take_until(target, '?');
  if (!is_name(query.name_)) throw BadRequest(404, "there is nothing of this name");
  while (!target.empty()) {
    std::string_view text = take_until(target, '&');
    const std::string_view key = take_until(text, '=');
    std::int64_t value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (key.empty() || !is_name(key) || parsed.ec != std::errc{} ||
        parsed.ptr != text.data() + text.size())
      throw BadRequest(400, "a parameter is written name=whole number");
    if (!query.values_.emplace(key, value).second)
      throw BadRequest(400, fmt::format("'{}' is there twice", key));
  }
  return query;
}

std::int64_t ViewQuery::number(const std::string& key, std::int64_t low, std::int64_t high) {
  const auto at = values_.find(key);
  if (at == values_.end()) throw BadRequest(400, fmt::format("'{}' is missing", key));
  const std::int64_t value = at->second;
  values_.erase(at);
  if (value < low || value > high)
    throw BadRequest(400, fmt::format("'{}' is {}; it must be {} .. {}", key, value, low, high));
  return value;
}

std::int64_t ViewQuery::number_or(const std::string& key, std::int64_t low, std::int64_t high,
                                  std::int64_t otherwise) {
  return values_.contains(key) ? number(key, low, high) : otherwise;
}

std::size_t ViewQuery::index(const std::string& key, std::size_t count) {
  const std::int64_t value = number(key, std::numeric_limits<std::int64_t>::min(),
                                    std::numeric_limits<std::int64_t>::max());
  if (value < 0 || static_cast<std::uint64_t>(value) >= count)
    throw BadRequest(404, fmt::format("'{}' is {}; there are {}", key, value, count));
  return static_cast<std::size_t>(value);
}

void ViewQuery::expect_all_read() const {
  if (!values_.empty())
    throw BadRequest(400,
                     fmt::format("'{}' is no parameter of '{}'", values_.begin()->first, name_));
}

std::string_view behind_token(std::string_view target, std::string_view token) {
  constexpr const char* kRefusal = "this page is opened by the whole URL that saccade view printed";
  if (target.size() < token.size() + 2 || target.front() != '/' || target[token.size() + 1] != '/')
    throw BadRequest(403, kRefusal);
  // All of it is compared, so that the time does not tell how much of a guess is right.
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= static_cast<unsigned char>(target[i + 1] ^ token[i]);
  if (difference != 0) throw BadRequest(403, kRefusal);
  return target.substr(token.size() + 2);
}

}  // namespace saccade
