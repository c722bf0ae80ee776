#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace saccade {

/// The manual page (section 1, groff's man macros) of the command or one of its verbs, from the
/// texts of its --help. `command`: complete, with all verbs. `verb`: nullptr for the command itself.
[[nodiscard]] std::string manual_page(const CLI::App& command, const CLI::App* verb);

}  // namespace saccade
