#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace saccade {

/// A request that is refused: the HTTP status (4xx) and what would be right.
class BadRequest : public std::runtime_error {
 public:
  BadRequest(int status, const std::string& problem)
      : std::runtime_error(problem), status_(status) {}
  [[nodiscard]] int status() const { return status_; }

 private:
  int status_;
};

/// What a page asks for: "events?recording=0&start_us=0&end_us=10000". Names are lower-case letters
/// and '_', values whole numbers; nothing is decoded, so that no text of a request reaches a file.
class ViewQuery {
 public:
  /// BadRequest 400 for every other text, and for a parameter that is named twice.
  [[nodiscard]] static ViewQuery parse(std::string_view target);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// A parameter's value; BadRequest 400 where it is missing or not in [low, high].
  [[nodiscard]] std::int64_t number(const std::string& key, std::int64_t low, std::int64_t high);
  /// The same, `otherwise` where it is missing.
  [[nodiscard]] std::int64_t number_or(const std::string& key, std::int64_t low, std::int64_t high,
                                       std::int64_t otherwise);
  /// An index into `count` things; BadRequest 404 where there is none of it.
  [[nodiscard]] std::size_t index(const std::string& key, std::size_t count);
  /// BadRequest 400 where a parameter was not asked for.
  void expect_all_read() const;

 private:
  std::string name_;
  std::map<std::string, std::int64_t> values_;
};

/// The part of an HTTP target behind "/TOKEN/". BadRequest 403 where it does not begin so.
[[nodiscard]] std::string_view behind_token(std::string_view target, std::string_view token);

}  // namespace saccade
