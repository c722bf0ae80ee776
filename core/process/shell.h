#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace saccade {

/// Words as one line that a POSIX shell takes apart into the same words again.
[[nodiscard]] std::string shell_line(std::span<const std::string> words);

/// The words of a line as shell_line() writes it, or as a person quotes it ('', "" and \\); nothing
/// is expanded, and a quote that nobody closed ends with the line.
[[nodiscard]] std::vector<std::string> shell_words(std::string_view line);

}  // namespace saccade
