#pragma once

#include <cstddef>
#include <string_view>

#include "core/event.h"

namespace saccade {

/// Reads the line of an event that `text` begins with if it has the usual form: seconds with a point
/// and 1 to 9 decimals, column, row, and polarity 0 or 1, with one space between them, ended by \n.
/// Gives the bytes of the line with its end; 0 for every other line, which may be right as well, and
/// near the end of the text: `event` may then hold anything. Exists for speed beside TextRow, which
/// takes every form and says what is wrong.
[[nodiscard]] std::size_t read_usual_line(std::string_view text, Event& event);

}  // namespace saccade
