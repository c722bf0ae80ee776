#pragma once

#include <filesystem>

#include "core/error.h"

namespace saccade {

/// A path that the system refuses, as an error of the input: a name that is too long, a loop of
/// links, a folder that may not be read. std::filesystem throws it wherever such a path is looked
/// at, and it is caught beside InputError.
[[nodiscard]] InputError refused_path(const std::filesystem::filesystem_error& error);

}  // namespace saccade
