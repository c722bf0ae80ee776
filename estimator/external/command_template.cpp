#include "estimator/external/command_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "core/check.h"
#include "core/config/suggest.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

constexpr std::array<const char*, 15> kPlaceholders{
    "events",  "calib",  "camera",  "groundtruth_start", "imu",   "input",
    "dataset", "out",    "start_s", "duration_s",        "end_s", "seed",
    "width",   "height", "threads"};

/// Calls `on_text` for what stands between placeholders and `on_name` for each of them. False where
/// a brace is not closed.
bool split_template(std::string_view text, const std::function<void(std::string_view)>& on_text,
                    const std::function<void(std::string_view)>& on_name) {
  while (!text.empty()) {
    const std::size_t brace = text.find_first_of("{}");
    on_text(text.substr(0, brace));
    if (brace == std::string_view::npos) return true;
    text.remove_prefix(brace);
    if (text.starts_with("{{") || text.starts_with("}}")) {
      on_text(text.substr(0, 1));
      text.remove_prefix(2);
      continue;
    }
    const std::size_t end = text.find('}');
    if (text.front() == '}' || end == std::string_view::npos) return false;
    on_name(text.substr(1, end - 1));
    text.remove_prefix(end + 1);
  }
  return true;
}

std::vector<std::string> known_names(const AdapterConfig& config) {
  std::vector<std::string> names(kPlaceholders.begin(), kPlaceholders.end());
  for (const auto& [name, file] : config.files) names.push_back(name);
  return names;
}

}  // namespace

std::string placeholder_problem(std::string_view text, const AdapterConfig& config) {
  const std::vector<std::string> names = known_names(config);
  std::string problem;
  const auto check = [&](std::string_view name) {
    if (!problem.empty()) return;
    if (std::find(names.begin(), names.end(), name) == names.end())
      problem = fmt::format("holds the unknown placeholder '{{{}}}'; {}", name,
                            config::suggestion(std::string(name), names, "placeholders"));
    else if (name == "groundtruth_start" && !(config.truth_s > 0))
      problem = "holds {groundtruth_start}, which needs start.truth_s above 0";
  };
  if (!split_template(
          text, [](std::string_view) {}, check) &&
      problem.empty())
    return "holds a brace that is no placeholder; write {{ or }} for a brace";
  return problem;
}

bool uses_placeholder(std::string_view text, std::string_view name) {
  bool found = false;
  split_template(
      text, [](std::string_view) {}, [&](std::string_view one) { found = found || one == name; });
  return found;
}

std::string substituted(std::string_view text, const Placeholders& values) {
  std::string result;
  const bool closed = split_template(
      text, [&](std::string_view part) { result += part; },
      [&](std::string_view name) {
        const auto value = values.find(name);
        SACCADE_CHECK(value != values.end());
        result += value->second;
      });
  SACCADE_CHECK(closed);
  return result;
}

std::vector<std::string> substituted_words(std::string_view line, const Placeholders& values) {
  std::vector<std::string> words = shell_words(line);
  for (std::string& word : words) word = substituted(word, values);
  return words;
}

}  // namespace saccade
