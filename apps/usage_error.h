#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace saccade {

/// What is wrong with a command line and what would be right: the nearest verb or option, and where
/// the help is.
[[nodiscard]] std::string explain_usage_error(const CLI::App& command, const CLI::ParseError& error,
                                              const std::vector<std::string>& arguments);

}  // namespace saccade
