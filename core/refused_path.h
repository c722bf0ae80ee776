#pragma once

#include <filesystem>
#include <optional>

#include "core/error.h"

namespace saccade {

/// A path that the system refuses as an error of the input: a name that is too long, links in a
/// circle, a folder that may not be read, a file where a folder should be. std::filesystem throws it
/// wherever such a path is looked at, and it is caught beside InputError. nullopt for other errors,
/// as of a disk, which no other input would cure.
[[nodiscard]] std::optional<InputError> refused_path(
    const std::filesystem::filesystem_error& error);

}  // namespace saccade
