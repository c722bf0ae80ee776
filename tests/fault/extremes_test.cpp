// Every number in the reference of keys, set to what nobody should set it to: refused as bad input, or taken and worked with
// inside of limits of time and memory. The keys are those that the command itself lists. $SACCADE_EXTREMES_ALL: every
// accepted value is simulated, not a part of them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Key {
  std::string name;  ///< from the root
  std::string type;
};

/// The cells of a row of a Markdown table, without blanks and code marks.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, '|');) {
    std::string text;
    for (const char c : cell)
      if (c != '`') text += c;
    const std::size_t begin = text.find_first_not_of(' ');
    cells.push_back(begin == std::string::npos
                        ? ""
                        : text.substr(begin, text.find_last_not_of(' ') + 1 - begin));
  }
  return cells;
}

/// The keys of a page of the reference that are numbers, and are in no list.
std::vector<Key> numbers_of(const std::vector<std::string>& command) {
  std::vector<Key> keys;
  std::string section;
  std::istringstream page(saccade_ok(command));
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) section = cells_of(line.substr(3))[0];
    if (!line.starts_with("| `")) continue;
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() < 4 || section.find("[]") != std::string::npos) continue;
    const bool is_number = cells[2].starts_with("number") || cells[2].starts_with("whole number");
    if (is_number) keys.push_back({(section.empty() ? "" : section + ".") + cells[1], cells[2]});
  }
  return keys;
}

const std::array<const char*, 8> kExtremes{".nan", ".inf",   "-.inf", "-1",
                                           "0",    "1e-308", "1e308", "99999999999999999999"};

void expect_refused_or_taken(const std::vector<std::string>& command,
                             const std::vector<Key>& keys) {
  EXPECT_GT(keys.size(), 3U);
  int refused = 0;
  int taken = 0;
  for (const Key& key : keys)
    for (const std::string value : kExtremes) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--set", key.name + "=" + value, "--print-config"});
      const CommandResult result = saccade(words);
      SCOPED_TRACE(key.name + "=" + value);
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2)
          << result.exit_code << result.output;
      if (value.find("nan") != std::string::npos || value.find("inf") != std::string::npos) {
        EXPECT_EQ(result.exit_code, 2) << "is no number";
      }
      if (result.exit_code == 2) {
        EXPECT_THAT(result.output, HasSubstr("--set " + key.name.substr(0, 3)));
      }
      ++(result.exit_code == 0 ? taken : refused);
    }
  std::cout << fmt::format("{} keys, {} values refused, {} taken\n", keys.size(), refused, taken);
}

TEST(Extremes, OfEveryModuleAreRefusedOrTaken) {
  for (const char* module :
       {"track", "depth", "reconstruct", "odometry", "refine", "stabilize", "mosaic", "rotation"}) {
    SCOPED_TRACE(module);
    expect_refused_or_taken({"run", module}, numbers_of({"run", module, "--reference"}));
  }
}

std::vector<std::string> small_simulation() {
  return {
      "simulate", shipped_config("simulation/walls.yaml"),          "--set", "duration_s=0.01",
      "--set",    "camera={width: 24, height: 18, fx: 20, fy: 20}", "--set", "frames.rate_hz=100",
      "-q"};
}

TEST(Extremes, OfASimulationAreRefusedOrTaken) {
  expect_refused_or_taken(small_simulation(), numbers_of({"simulate", "--reference"}));
}

/// As a shell tells it: 128 + signal where one ended it.
int exit_code_within_limits(const std::vector<std::string>& words, const fs::path& log) {
  std::vector<char*> argv{const_cast<char*>(SACCADE_COMMAND)};
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    constexpr rlim_t kMemory = rlim_t{4} << 30U;
    constexpr rlim_t kSeconds = 20;
    const rlimit memory{kMemory, kMemory};
    const rlimit seconds{kSeconds, kSeconds};
    setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CPU, &seconds);
    std::freopen(log.c_str(), "w", stderr);
    std::freopen("/dev/null", "w", stdout);
    execv(SACCADE_COMMAND, argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(Extremes, WhatIsTakenIsSimulatedOrRefused) {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const std::size_t stride = std::getenv("SACCADE_EXTREMES_ALL") == nullptr ? 12 : 1;
  const std::vector<Key> keys = numbers_of({"simulate", "--reference"});
  std::size_t index = 0;
  for (const Key& key : keys)
    for (const std::string value : {"0", "1e-308", "1e-9", "1e6", "1e308"}) {
      if (index++ % stride != 0) continue;
      std::vector<std::string> words = small_simulation();
      words.insert(words.end(),
                   {"--set", key.name + "=" + value, "-o", (folder.path() / "d").string()});
      const int code = exit_code_within_limits(words, log);
      EXPECT_TRUE(code == 0 || code == 2)
          << key.name << "=" << value << " ended with " << code << ": " << read_file(log);
      fs::remove_all(folder.path() / "d");
      fs::remove_all(folder.path() / ".d.unfinished");
    }
}

TEST(Extremes, ASensorThatDoesNotFitIntoMemoryIsRefusedBeforeItIsMade) {
  const TemporaryFolder folder;
  const CommandResult result =
      saccade({"simulate", shipped_config("simulation/walls.yaml"), "-o",
               (folder.path() / "d").string(), "--set", "camera={width: 65535, height: 65535}"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("recording 65535 x 65535 pixels takes about"));
  EXPECT_THAT(result.output, HasSubstr("lower width and height"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace saccade::testing
