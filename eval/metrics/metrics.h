#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {

/// Scores by dotted key ("trajectory.dt_rel_percent.mean"), in alphabetical order. nullopt is "not
/// measured" (no ground truth, no depth, too few poses) and never a pass; it is `null` in the file.
/// No value is NaN or infinite: set() turns those into nullopt.
class Metrics {
 public:
  void set(std::string key, std::optional<double> value);

  /// The value at `key`; nullopt where it is absent or null.
  [[nodiscard]] std::optional<double> get(std::string_view key) const;
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] const std::map<std::string, std::optional<double>, std::less<>>& values() const {
    return values_;
  }

  [[nodiscard]] bool operator==(const Metrics&) const = default;

 private:
  std::map<std::string, std::optional<double>, std::less<>> values_;
};

/// Nested JSON, keys sorted, doubles in their shortest exact form, a newline at the end: equal
/// metrics give equal bytes. No key may be a prefix of another ("a" beside "a.b"). `inputs`: texts
/// that stand beside them as the object "inputs", where there are any.
[[nodiscard]] std::string to_json(const Metrics& metrics,
                                  const std::map<std::string, std::string>& inputs = {});

/// Reads what to_json() wrote. Numbers become values, null becomes nullopt, and every other leaf
/// (text, truth values, lists) is skipped. `source` names the text in errors. Throws InputError
/// where the text is no JSON object.
[[nodiscard]] Metrics parse_json_metrics(std::string_view text, const std::string& source);

/// The same from a file.
[[nodiscard]] Metrics read_json_metrics(const std::filesystem::path& file);

/// The texts of the object `name` of such a file; empty where it holds none.
[[nodiscard]] std::map<std::string, std::string> read_json_texts(const std::filesystem::path& file,
                                                                 const std::string& name);

}  // namespace saccade
