#pragma once

#include <string_view>

namespace saccade {

/// Version of the library and the command, "MAJOR.MINOR.PATCH".
[[nodiscard]] std::string_view version();

/// Commit that was built: twelve hexadecimal digits, with "-dirty" after it when tracked files
/// differed from it; "unknown" when the sources did not come from a git checkout.
[[nodiscard]] std::string_view git_commit();

}  // namespace saccade
