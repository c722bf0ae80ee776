#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace saccade::config {

// Faults of YAML text that yaml-cpp 0.7 passes over in silence.

/// Line (1-based) of the first control character that is no white space. yaml-cpp takes some of
/// them for the end of the file.
[[nodiscard]] std::optional<int> line_of_control_character(std::string_view text);

/// Whether the quoted scalar that begins at `position`, behind its anchor and tag, has its closing
/// quote. yaml-cpp lets the end of the file close it.
[[nodiscard]] bool is_closed_quote(std::string_view text, std::size_t position);

}  // namespace saccade::config
