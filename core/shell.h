#pragma once

#include <span>
#include <string>

namespace saccade {

/// Words as one line that a POSIX shell takes apart into the same words again.
[[nodiscard]] std::string shell_line(std::span<const std::string> words);

}  // namespace saccade
