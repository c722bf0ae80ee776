#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/external/adapter_config.h"

namespace saccade {

/// What the placeholders of a command stand for, by name.
using Placeholders = std::map<std::string, std::string, std::less<>>;

/// What is wrong with the placeholders of `text`, with the right ones; empty: nothing. "{{" is a
/// brace.
[[nodiscard]] std::string placeholder_problem(std::string_view text, const AdapterConfig& config);

/// Whether `text` holds the placeholder {name}.
[[nodiscard]] bool uses_placeholder(std::string_view text, std::string_view name);

/// `text` with its placeholders replaced; all of them are known (contract).
[[nodiscard]] std::string substituted(std::string_view text, const Placeholders& values);

/// The words of a command line (core/process/shell.h), each substituted: a value with blanks stays one word.
[[nodiscard]] std::vector<std::string> substituted_words(std::string_view line,
                                                         const Placeholders& values);

}  // namespace saccade
