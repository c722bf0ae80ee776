#pragma once

#include <vector>

#include "tests/fuzz/fuzz_target.h"

namespace saccade::fuzz {

/// The parts of the table, by the kind of file.
[[nodiscard]] std::vector<Target> text_targets();
[[nodiscard]] std::vector<Target> event_targets();
[[nodiscard]] std::vector<Target> binary_targets();
[[nodiscard]] std::vector<Target> folder_targets();

}  // namespace saccade::fuzz
