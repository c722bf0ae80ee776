#include "eval/store/where_expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "core/config/suggest.h"
#include "core/error.h"
#include "eval/store/result_row.h"

namespace saccade {
namespace {

[[noreturn]] void fail_at(std::size_t at, const std::string& problem) {
  throw InputError(fmt::format("--where, character {}", at + 1), problem);
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

bool is_keyword(std::string_view word) {
  static constexpr std::array<std::string_view, 9> kKeywords{"and",  "or", "not",  "in",     "like",
                                                             "glob", "is", "null", "between"};
  return std::find(kKeywords.begin(), kKeywords.end(), lower_case(word)) != kKeywords.end();
}

/// How many letters of `text` from `at` on are a name or a number; names hold dots.
std::size_t word_length(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]) || text[end] == '.'))
    ++end;
  return end - at;
}

/// 12, 0.5, 1e-3: without a sign.
std::size_t number_length(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t power = end + 1;
    if (power < text.size() && (text[power] == '-' || text[power] == '+')) ++power;
    if (power < text.size() && is_digit(text[power])) end = power;
    while (end < text.size() && is_digit(text[end])) ++end;
  }
  return end - at;
}

std::size_t operator_length(std::string_view text, std::size_t at) {
  for (const std::string_view two : {"==", "!=", "<>", "<=", ">="})
    if (text.substr(at, 2) == two) return 2;
  return std::string_view("=<>+-*/%,()").find(text[at]) == std::string_view::npos ? 0 : 1;
}

/// The text in quotes that begin at `at`, where a doubled quote stands for itself; moves `at`
/// behind it.
std::string quoted_text(std::string_view text, std::size_t& at) {
  const std::size_t begin = at;
  const char quote = text[at++];
  std::string inside;
  for (; at < text.size(); ++at) {
    if (text[at] == quote && (at + 1 >= text.size() || text[at + 1] != quote)) {
      ++at;
      return inside;
    }
    if (text[at] == quote) ++at;
    inside += text[at];
  }
  fail_at(begin, "the text that begins here has no closing quote");
}

std::string name_sql(const std::string& name, std::size_t at,
                     const std::function<std::string(const std::string&)>& metric_sql,
                     std::span<const std::string> metrics) {
  if (is_keyword(name)) return lower_case(name);
  std::vector<std::string> names;
  for (const ResultColumn& column : result_columns()) {
    if (column.name == name) return "\"" + name + "\"";
    names.push_back(column.name);
  }
  if (std::string sql = metric_sql(name); !sql.empty()) return sql;
  std::vector<std::string> all = names;
  all.insert(all.end(), metrics.begin(), metrics.end());
  const std::optional<std::string> near = config::nearest(name, all);
  fail_at(at, fmt::format(
                  "'{}' is no column and no metric of a stored run; {} (text goes in quotes)", name,
                  near ? "did you mean '" + *near + "'?"
                       : "columns: " + config::joined(names) + "; metrics as in metrics.json"));
}

}  // namespace

WhereExpression::WhereExpression(std::string_view expression,
                                 const std::function<std::string(const std::string&)>& metric_sql,
                                 std::span<const std::string> metrics)
    : end_(expression.size()) {
  std::vector<std::size_t> open;
  for (std::size_t at = 0; at < expression.size();) {
    const char c = expression[at];
    const std::size_t begin = at;
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at;
    } else if (c == '\'' || c == '"') {
      texts_.push_back(quoted_text(expression, at));
      add(begin, expression.substr(begin, at - begin), "?");
    } else if (is_letter(c)) {
      at += word_length(expression, at);
      const std::string name(expression.substr(begin, at - begin));
      add(begin, name, name_sql(name, begin, metric_sql, metrics));
    } else if (const std::size_t digits = number_length(expression, at); digits > 0) {
      at += digits;
      const std::string number(expression.substr(begin, digits));
      add(begin, number, number);
    } else if (const std::size_t length = operator_length(expression, at); length > 0) {
      at += length;
      if (c == '(') open.push_back(begin);
      if (c == ')' && open.empty()) fail_at(begin, "this bracket closes nothing");
      if (c == ')') open.pop_back();
      const std::string sign(expression.substr(begin, length));
      add(begin, sign, sign);
    } else {
      fail_at(begin, fmt::format("'{}' has no meaning in a condition", c));
    }
  }
  if (!open.empty()) fail_at(open.back(), "this bracket is not closed");
  sql_ = tokens_.empty() ? "1" : "(" + sql_ + ")";
}

void WhereExpression::add(std::size_t at, std::string_view text, const std::string& sql) {
  sql_ += ' ';
  tokens_.push_back({at, std::string(text), sql_.size() + 1});  // behind the bracket around all
  sql_ += sql;
}

void WhereExpression::fail(const SqlFault& fault, std::size_t prefix) const {
  const Token* last = nullptr;
  if (fault.at && *fault.at < prefix + sql_.size() - 1)
    for (const Token& token : tokens_)
      if (prefix + token.sql_at <= *fault.at) last = &token;
  if (last != nullptr) fail_at(last->at, "'" + last->text + "' does not fit here");
  if (fault.message.find("syntax error") != std::string::npos)
    fail_at(end_, "the condition ends too early");
  throw InputError("--where", fault.message);
}

}  // namespace saccade
