#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/store/database.h"

namespace saccade {

/// A condition over the columns of a result store and its metrics, as people write it:
///   module = 'odometry' and dataset like 'walls%' and trajectory.drift_percent < 1
/// Names are those of result_columns() and of metrics.json; text stands in '' or ""; there are
/// and, or, not, in (...), like, glob, is null, between, = == != <> < <= > >= + - * / % and
/// brackets. A metric that a run does not have is null, for which no comparison holds. What else
/// SQL has is not let through.
class WhereExpression {
 public:
  /// `metric_sql`: a metric's value as SQL, empty for an unknown name; `metrics`: their names, for
  /// a suggestion. An empty expression holds always. InputError with the place ("--where, character
  /// 12") for unknown names and letters, quotes that are not closed, brackets that do not match.
  WhereExpression(std::string_view expression,
                  const std::function<std::string(const std::string&)>& metric_sql,
                  std::span<const std::string> metrics);

  /// With a parameter `?` for each text.
  [[nodiscard]] const std::string& sql() const { return sql_; }
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

  /// Throws the InputError for what SQLite finds wrong with sql(), which stands behind `prefix`
  /// bytes of the statement.
  [[noreturn]] void fail(const SqlFault& fault, std::size_t prefix) const;

 private:
  struct Token {
    std::size_t at = 0;  ///< in the expression
    std::string text;    ///< as written
    std::size_t sql_at = 0;
  };

  void add(std::size_t at, std::string_view text, const std::string& sql);

  std::size_t end_;  ///< length of the expression
  std::string sql_;
  std::vector<std::string> texts_;
  std::vector<Token> tokens_;
};

}  // namespace saccade
