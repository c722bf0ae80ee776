#include "eval/configuration_name.h"

#include <span>
#include <vector>

#include "core/io/files/sha256.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

/// The values that a command line gives to an option: "-c X", "--config X", "--config=X".
std::vector<std::string> option_values(const std::vector<std::string>& words,
                                       const std::string& long_name,
                                       const std::string& short_name = {}) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool named = words[i] == long_name || (!short_name.empty() && words[i] == short_name);
    if (named && i + 1 < words.size())
      values.push_back(words[++i]);
    else if (words[i].starts_with(long_name + "="))
      values.push_back(words[i].substr(long_name.size() + 1));
  }
  return values;
}

/// The last one counts.
std::filesystem::path last_file(const std::vector<std::string>& words) {
  const std::vector<std::string> files = option_values(words, "--config", "-c");
  return files.empty() ? "" : files.back();
}

}  // namespace

std::filesystem::path configuration_file(const RunRecord& record) {
  return last_file(shell_words(record.command));
}

std::string configuration_sha256(const RunRecord& record) {
  const std::string& text = record.config_yaml;
  return text.empty() ? std::string() : sha256(std::as_bytes(std::span(text)));
}

std::string configuration_name(const RunRecord& record) {
  constexpr std::size_t kShown = 8;
  if (record.command.empty()) return configuration_sha256(record).substr(0, kShown);
  const std::vector<std::string> words = shell_words(record.command);
  const std::filesystem::path file = last_file(words);
  std::string name = file.empty() ? "defaults" : file.stem().string();
  for (const std::string& setting : option_values(words, "--set"))
    if (!setting.starts_with("seed=")) name += " " + setting;
  if (!record.poses_from.empty()) name += ", estimated poses";
  if (record.smooth_poses_s) name += ", smoothed poses";
  if (!record.depth_from.empty()) name += ", estimated depth";
  return name;
}

}  // namespace saccade
