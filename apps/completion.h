#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace saccade {

/// What a word of the command line may become.
struct Completion {
  std::string text;
  std::string help;  ///< first sentence of its help; may be empty
};

/// Completions of the last of `words`, which follow the name of the command; it may be empty. They
/// come from the tables that the command itself reads: verbs, options with their choices, modules,
/// shipped configurations, and the keys of --set. Empty where a file is expected, which shells
/// complete themselves.
[[nodiscard]] std::vector<Completion> complete(const CLI::App& command,
                                               const std::vector<std::string>& words);

/// A script that makes a shell ask `saccade completion words`. `shell`: bash, zsh or fish; throws
/// InputError for another.
[[nodiscard]] std::string completion_script(const std::string& shell);

}  // namespace saccade
