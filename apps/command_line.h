#pragma once

#include <string>

namespace saccade {

/// Remembers how the program was called; once, in main().
void set_command_line(int argc, const char* const* argv);

/// The call as one line that a shell runs again, for the provenance of what it writes.
[[nodiscard]] const std::string& command_line();

}  // namespace saccade
