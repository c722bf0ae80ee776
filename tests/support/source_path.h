#pragma once

#include <string>

namespace saccade::testing {

/// A file or folder of the repository, by its path from the root. One source alone knows where that
/// is, so that the others compile alike wherever it stands.
[[nodiscard]] std::string source_path(const std::string& relative);

}  // namespace saccade::testing
