#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "eval/metrics/metrics.h"
#include "tests/support/command.h"
#include "tests/support/source_path.h"

namespace saccade::testing {

/// A cache of datasets that is in force while this lives, in place of the one before.
class OwnCache {
 public:
  OwnCache() {
    if (const char* before = std::getenv("SACCADE_CACHE")) before_ = before;
    setenv("SACCADE_CACHE", folder_.path().c_str(), 1);
  }
  ~OwnCache() {
    if (before_)
      setenv("SACCADE_CACHE", before_->c_str(), 1);
    else
      unsetenv("SACCADE_CACHE");
  }
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  std::optional<std::string> before_;
};
/// The tests of a program share one, and leave the user's alone.
inline const OwnCache kOwnCache;

/// Runs the command of this build.
[[nodiscard]] inline CommandResult saccade(const std::vector<std::string>& arguments) {
  return run_command(SACCADE_COMMAND, arguments);
}

/// The same where it must succeed; what it printed.
inline std::string saccade_ok(const std::vector<std::string>& arguments) {
  const CommandResult result = saccade(arguments);
  if (result.exit_code != 0) {
    std::string line = "saccade";
    for (const std::string& argument : arguments) line += " " + argument;
    ADD_FAILURE() << line << "\nended with " << result.exit_code << ":\n" << result.output;
  }
  return result.output;
}

/// A shipped configuration, e.g. "simulation/walls.yaml".
[[nodiscard]] inline std::string shipped_config(const std::string& name) {
  return testing::source_path("configs/") + name;
}

/// A score that must be there.
[[nodiscard]] inline double score(const Metrics& metrics, const std::string& key) {
  const std::optional<double> value = metrics.get(key);
  if (!value) ADD_FAILURE() << "there is no score " << key;
  return value.value_or(0);
}

[[nodiscard]] inline bool on_search_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (std::filesystem::exists(std::filesystem::path(folder) / program)) return true;
  return false;
}

}  // namespace saccade::testing
